#include "radioslam/pipeline/collect_results.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/graph/marginals.hpp"
#include "radioslam/graph/residuals.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMaxSamplesShown = 4000;
constexpr double kHalfBin = 0.5;
constexpr double kSurprise = 3;  // standard deviations

template <class Pose>
typename Pose::Point end_position(const PoseGraph<Pose>& graph, const RangeEnd<Pose>& end) {
  return graph.poses[end.pose.index()] * end.lever_arm;
}

/// T_report_graph of each component; components without a known pose are reported in their first robot's
/// start frame.
template <class Pose>
std::vector<Pose> component_frames(const JointGraph<Pose>& joint, const std::vector<Pose>& poses,
                                   const TeamAlignment<Pose>& alignment) {
  std::vector<Pose> frames(joint.robots.size());
  std::vector<bool> seen(joint.robots.size(), false);
  for (std::size_t r = 0; r < joint.robots.size(); ++r) {
    const auto c = static_cast<std::size_t>(alignment.component[r]);
    if (seen[c] || alignment.absolute[c]) continue;
    seen[c] = true;
    const RobotVariables& robot = joint.robots[r];
    frames[c] = pose_as<Pose>(robot.odometry.front()) * poses[robot.poses.front().index()].inverse();
  }
  return frames;
}

/// The first pose behind the segment of `pose`: the odometry does not lead there.
std::size_t end_of_segment(const std::vector<TrajectorySegment>& segments, PoseId pose) {
  for (const TrajectorySegment& segment : segments)
    if (pose.index() < segment.first_pose + segment.pose_count)
      return segment.first_pose + segment.pose_count;
  return 0;
}

template <class Pose>
RobotResult collect_robot(const RobotVariables& robot, const JointGraph<Pose>& joint,
                          const std::vector<Pose>& poses, const Pose& frame) {
  RobotResult result;
  result.id = robot.id;
  result.start_known = robot.T_common_start.has_value();
  result.untied = robot.untied;
  const std::size_t behind_gap = end_of_segment(joint.team.segments, robot.poses.front());
  std::vector<StampedPose<SE3>> estimate, odometry;
  SE3 T_frame_start;
  for (std::size_t k = 0; k < robot.poses.size(); ++k) {
    const SE3& by_odometry = robot.odometry[k];
    const SE3 estimated = as_se3(Pose(frame * poses[robot.poses[k].index()]), by_odometry.translation().z());
    if (k == 0) T_frame_start = robot.T_common_start.value_or(estimated * by_odometry.inverse());
    estimate.push_back({robot.stamps[k], estimated});
    if (robot.poses[k].index() < behind_gap)
      odometry.push_back({robot.stamps[k], T_frame_start * by_odometry});
  }
  result.estimate = Trajectory<SE3>(std::move(estimate));
  result.odometry = Trajectory<SE3>(std::move(odometry));
  if (robot.drift.valid()) {
    result.yaw_drift_per_m_rad = joint.team.graph.drifts[robot.drift.index()][0];
    result.scale_error = joint.team.graph.drifts[robot.drift.index()][1];
  }
  return result;
}

ClosureResult result_of(const FactorOrigin& origin, ClosureKind kind, double statistic) {
  return {origin.robot_i, origin.stamp_i,           origin.robot_j, origin.stamp_j,
          kind,           ClosureStatus::kAccepted, statistic,      {}};
}

ClosureResult link_result(const FactorOrigin& origin, ClosureKind kind, double statistic, double weight) {
  constexpr double kHalf = 0.5;
  ClosureResult result = result_of(origin, kind, statistic);
  if (weight < kHalf) {
    result.status = ClosureStatus::kRejected;
    result.reason =
        kind == ClosureKind::kAoa ? "no path is likely direct" : "unlikely to be the direct distance";
  }
  return result;
}

template <class Pose>
TransformResult transform_between(const JointGraph<Pose>& joint, std::size_t i, std::size_t j,
                                  const typename Pose::Jacobian& cov_start_i_start_j) {
  const RobotVariables &robot_i = joint.robots[i], &robot_j = joint.robots[j];
  const PoseId start_i = robot_i.poses.front(), start_j = robot_j.poses.front();
  const auto& poses = joint.team.graph.poses;
  const Pose T_start_i_start_j = poses[start_i.index()].inverse() * poses[start_j.index()];
  const Pose T_i_start_i = pose_as<Pose>(robot_i.odometry.front());
  const Pose T_j_start_j = pose_as<Pose>(robot_j.odometry.front());
  const auto into_j = T_j_start_j.adjoint();
  return {robot_i.id, robot_j.id, as_se3(Pose(T_i_start_i * T_start_i_start_j * T_j_start_j.inverse()), 0),
          into_j * cov_start_i_start_j * into_j.transpose()};
}

}  // namespace

template <class Pose>
std::vector<RobotResult> collect_robots(const JointGraph<Pose>& joint, const std::vector<Pose>& poses,
                                        const TeamAlignment<Pose>& alignment) {
  const std::vector<Pose> frames = component_frames(joint, poses, alignment);
  std::vector<RobotResult> robots;
  for (std::size_t r = 0; r < joint.robots.size(); ++r) {
    const auto component = static_cast<std::size_t>(alignment.component[r]);
    robots.push_back(collect_robot(joint.robots[r], joint, poses, frames[component]));
    robots.back().placed = alignment.placed[r];
  }
  return robots;
}

template <class Pose>
std::vector<ClosureResult> collect_radio_links(const JointGraph<Pose>& joint) {
  const auto& graph = joint.team.graph;
  std::vector<ClosureResult> results;
  for (std::size_t k = 0; k < joint.origins.ranges.size(); ++k) {
    const FactorOrigin& origin = joint.origins.ranges[k];
    if (origin.source == FactorSource::kRange && origin.robot_i.valid() && origin.robot_j.valid())
      results.push_back(link_result(origin, ClosureKind::kRange, squared_norm(graph, graph.ranges[k]),
                                    graph.ranges[k].weight));
  }
  for (std::size_t k = 0; k < joint.origins.bearings.size(); ++k) {
    if (!joint.origins.bearings[k].robot_j.valid()) continue;
    const auto& bearing = joint.team.bearings[k];
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t p = 0; p < bearing.paths.size(); ++p)
      least = std::min(least, squared_norm(graph, path_factor(bearing, p)));
    const BearingWeight& bearing_weight = joint.bearing_weights[k];
    results.push_back(
        link_result(joint.origins.bearings[k], ClosureKind::kAoa, least, bearing_weight.weight));
    results.back().path_weights = bearing_weight.paths;
    if (bearing_weight.too_near) results.back().reason = "the robots are too near for an angle to count";
  }
  return results;
}

template <class Pose>
std::vector<ClosureResult> collect_fingerprint_closures(const JointGraph<Pose>& joint) {
  std::vector<ClosureResult> results;
  for (std::size_t k = 0; k < joint.origins.ranges.size(); ++k) {
    const FactorOrigin& origin = joint.origins.ranges[k];
    if (origin.source != FactorSource::kFingerprint) continue;
    const auto& range = joint.team.graph.ranges[k];
    const double distance =
        (end_position(joint.team.graph, range.j) - end_position(joint.team.graph, range.i)).norm();
    ClosureResult result =
        result_of(origin, ClosureKind::kFingerprint, std::pow((distance - range.range_m) / range.sigma_m, 2));
    if (result.statistic > kChiSquared99) {
      result.status = ClosureStatus::kRejected;
      result.reason = "the estimate disagrees";
    }
    results.push_back(std::move(result));
  }
  return results;
}

template <class Pose>
std::vector<TransformResult> collect_transforms(const JointGraph<Pose>& joint,
                                                const TeamAlignment<Pose>& alignment,
                                                const Marginals<Pose>& marginals) {
  std::vector<TransformResult> transforms;
  const auto placed_with = [&](std::size_t i, std::size_t j) {
    return alignment.placed[i] && alignment.placed[j] && alignment.component[i] == alignment.component[j];
  };
  std::vector<PoseId> starts;
  for (const RobotVariables& robot : joint.robots) starts.push_back(robot.poses.front());
  const auto covariances = marginals.relative_poses(starts);
  auto covariance = covariances.begin();
  for (std::size_t i = 0; i < joint.robots.size(); ++i)
    for (std::size_t j = i + 1; j < joint.robots.size(); ++j, ++covariance)
      if (placed_with(i, j)) transforms.push_back(transform_between(joint, i, j, *covariance));
  return transforms;
}

template <class Pose>
std::vector<std::string> odometry_notes(const Mission& mission, const JointGraph<Pose>& joint,
                                        const Marginals<Pose>& marginals) {
  std::vector<std::string> notes;
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    const Robot& robot = mission.robots[r];
    const DriftId drift = joint.robots[r].drift;
    if (!drift.valid()) continue;
    const Eigen::Vector2d estimated = joint.team.graph.drifts[drift.index()].cwiseAbs();
    const Eigen::Vector2d sigma = marginals.drift(drift).diagonal().cwiseMax(0).cwiseSqrt();
    const Eigen::Vector2d stated(robot.odometry_noise.sigma_yaw_drift_per_m_rad,
                                 robot.odometry_noise.sigma_scale);
    if (estimated[0] > kSurprise * std::max(stated[0], sigma[0]))
      notes.push_back("the odometry of " + robot.id +
                      " has a constant yaw drift larger than its stated noise");
    if (estimated[1] > kSurprise * std::max(stated[1], sigma[1]))
      notes.push_back("the odometry of " + robot.id + " has a scale error larger than its stated noise");
  }
  return notes;
}

/// How much a prior's residual exceeds what everything else allows; 1 is significant. With the prior's
/// information L L^T and the marginal covariance P, the residual L^T r has the covariance I - L^T P L.
template <class Pose>
double contradiction(const PosePriorFactor<Pose>& prior, const Pose& estimate,
                     const typename Pose::Jacobian& covariance) {
  constexpr double kMinVariance = 0.01;  // below, nothing else measures the mode
  constexpr double kFalseAlarm = 1e-5;
  const Cholesky<typename Pose::Jacobian> root(prior.information);
  if (!root.succeeded()) return 0;
  const typename Pose::Jacobian upper = root.lower().transpose();
  const typename Pose::Tangent r = upper * (prior.prior.inverse() * estimate).log();
  const typename Pose::Jacobian variance =
      Pose::Jacobian::Identity() - upper * covariance * upper.transpose();
  const SymmetricEigen<typename Pose::Jacobian> modes = symmetric_eigen(variance);
  double statistic = 0;
  int dof = 0;
  for (int k = 0; k < Pose::kDof; ++k) {
    if (modes.values[k] < kMinVariance) continue;
    statistic += std::pow(modes.vectors.col(k).dot(r), 2) / modes.values[k];
    ++dof;
  }
  return dof == 0 ? 0 : statistic / chi_squared_quantile(1 - kFalseAlarm, dof);
}

template <class Pose>
std::optional<std::string> start_note(const JointGraph<Pose>& joint, const Marginals<Pose>& marginals) {
  double largest = 1;
  const RobotVariables* contradicted = nullptr;
  for (const PosePriorFactor<Pose>& prior : joint.team.graph.pose_priors) {
    const auto robot = std::find_if(joint.robots.begin(), joint.robots.end(),
                                    [&](const RobotVariables& r) { return r.poses.front() == prior.i; });
    if (prior.gravity_only || robot == joint.robots.end() || !robot->T_common_start) continue;
    const double ratio =
        contradiction(prior, joint.team.graph.poses[prior.i.index()], marginals.pose(prior.i));
    if (ratio > largest) largest = ratio, contradicted = &*robot;
  }
  if (!contradicted) return std::nullopt;
  return "the stated start of robot " + contradicted->id +
         " contradicts odometry and links of the team: it is wrong, or that of a robot it has links with";
}

void add_rssi_offsets(std::vector<RobotResult>& robots, const RssiOffsets& offsets) {
  for (std::size_t r = 0; r < std::min(robots.size(), offsets.robots.size()); ++r) {
    const RssiOffsetEstimate& device = offsets.robots[r];
    robots[r].rssi_offset = device.status;
    if (device.pairs == 0) continue;
    robots[r].rssi_offset_db = device.offset_db;
    robots[r].sigma_rssi_offset_db = device.sigma_db;
  }
}

std::string rssi_offset_note(const std::vector<RobotResult>& robots) {
  const auto [weakest, strongest] = std::minmax_element(
      robots.begin(), robots.end(),
      [](const RobotResult& a, const RobotResult& b) { return a.rssi_offset_db < b.rssi_offset_db; });
  std::ostringstream note;
  note << std::fixed << std::setprecision(1) << "RSSI measured by " << strongest->id << " is "
       << strongest->rssi_offset_db - weakest->rssi_offset_db << " dB above that of " << weakest->id
       << ": every robot's offset was corrected (rssi_offset_db in summary.json)";
  return note.str();
}

SimilarityModelResult collect_similarity_model(const RadioMeasurements& radio, const RadioParams& params) {
  SimilarityModelResult model;
  model.measure = params.measure;
  const double bin = params.distance_model.bin_width;
  const auto bins = static_cast<int>(std::ceil(1 / bin - kHalfBin));
  for (int b = 0; b < bins; ++b) {
    const double s = (b + kHalfBin) * bin;
    if (const auto p = radio.near_model.predict(s))
      model.bins.push_back({s, p->mean_m, p->sigma_m, p->samples});
  }
  const auto& samples = radio.near_model.samples();
  const std::size_t stride = std::max<std::size_t>(1, samples.size() / kMaxSamplesShown);
  for (std::size_t i = 0; i < samples.size(); i += stride)
    model.samples.emplace_back(samples[i].similarity, samples[i].distance_m);
  return model;
}

template <class Pose>
std::vector<Component> collect_components(const JointGraph<Pose>& joint,
                                          const TeamAlignment<Pose>& alignment) {
  std::vector<Component> components;
  for (std::size_t r = 0; r < joint.robots.size(); ++r) {
    const auto c = static_cast<std::size_t>(alignment.component[r]);
    if (components.size() <= c) components.resize(c + 1);
    components[c].robots.push_back(joint.robots[r].id);
  }
  return components;
}

#define RADIOSLAM_COLLECT(Pose)                                                                       \
  template std::vector<RobotResult> collect_robots(const JointGraph<Pose>&, const std::vector<Pose>&, \
                                                   const TeamAlignment<Pose>&);                       \
  template std::vector<ClosureResult> collect_radio_links(const JointGraph<Pose>&);                   \
  template std::vector<TransformResult> collect_transforms(                                           \
      const JointGraph<Pose>&, const TeamAlignment<Pose>&, const Marginals<Pose>&);                   \
  template std::optional<std::string> start_note(const JointGraph<Pose>&, const Marginals<Pose>&);    \
  template std::vector<std::string> odometry_notes(const Mission&, const JointGraph<Pose>&,           \
                                                   const Marginals<Pose>&);                           \
  template std::vector<ClosureResult> collect_fingerprint_closures(const JointGraph<Pose>&);          \
  template std::vector<Component> collect_components(const JointGraph<Pose>&, const TeamAlignment<Pose>&);
RADIOSLAM_COLLECT(SE2)
RADIOSLAM_COLLECT(SE3)
#undef RADIOSLAM_COLLECT

}  // namespace radioslam
