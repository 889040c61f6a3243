#include "radioslam/pipeline/collect_results.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/graph/marginals.hpp"
#include "radioslam/graph/residuals.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMostSamplesShown = 4000;
constexpr double kSurprise = 3;  // standard deviations

template <class Pose>
typename Pose::Point end_position(const PoseGraph<Pose>& graph, const RangeEnd<Pose>& end) {
  return graph.poses[end.pose.index()] * end.lever_arm;
}

/// T_report_graph of each component: components without a known pose are told in their first robot's start.
template <class Pose>
std::vector<Pose> component_frames(const Mission& mission, const JointGraph<Pose>& joint,
                                   const TeamFrame& team_frame) {
  std::vector<bool> known(mission.robots.size(), false), seen(mission.robots.size(), false);
  std::vector<Pose> frames(mission.robots.size());
  for (std::size_t r = 0; r < mission.robots.size(); ++r)
    if (mission.robots[r].initial_pose) known[static_cast<std::size_t>(team_frame.component[r])] = true;
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    const auto c = static_cast<std::size_t>(team_frame.component[r]);
    if (seen[c] || known[c]) continue;
    seen[c] = true;
    const Pose first = joint.graph.poses[joint.robots[r].first_pose];
    frames[c] = pose_as<Pose>(mission.robots[r].odometry.front().pose) * first.inverse();
  }
  return frames;
}

template <class Pose>
RobotResult collect_robot(const Robot& robot, const JointGraph<Pose>& joint, std::size_t r,
                          const Pose& frame) {
  const RobotVariables& variables = joint.robots[r];
  RobotResult result;
  result.id = robot.id;
  result.start_known = robot.initial_pose.has_value();
  std::vector<StampedPose<SE3>> estimate, odometry;
  const SE3 first_odometry = robot.odometry.front().pose;
  SE3 T_frame_start;
  for (std::size_t k = 0; k < variables.rows.size(); ++k) {
    const SE3& by_odometry = robot.odometry[variables.rows[k]].pose;
    const Pose pose = frame * joint.graph.poses[variables.first_pose + k];
    const SE3 estimated = as_se3(pose, by_odometry.translation().z());
    if (k == 0)
      T_frame_start = (robot.initial_pose ? *robot.initial_pose : estimated) * first_odometry.inverse();
    estimate.push_back({variables.stamps[k], estimated});
    odometry.push_back({variables.stamps[k], T_frame_start * by_odometry});
  }
  result.estimate = Trajectory<SE3>(std::move(estimate));
  result.odometry = Trajectory<SE3>(std::move(odometry));
  result.yaw_drift_per_m_rad = joint.graph.drifts[r][0];
  result.scale_error = joint.graph.drifts[r][1];
  return result;
}

}  // namespace

template <class Pose>
std::vector<RobotResult> collect_robots(const Mission& mission, const JointGraph<Pose>& joint,
                                        const TeamFrame& team_frame) {
  const std::vector<Pose> frames = component_frames(mission, joint, team_frame);
  std::vector<RobotResult> robots;
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    const auto component = static_cast<std::size_t>(team_frame.component[r]);
    robots.push_back(collect_robot(mission.robots[r], joint, r, frames[component]));
    robots.back().placed = team_frame.placed[r];
  }
  return robots;
}

template <class Pose>
std::vector<ClosureResult> collect_closures(const RadioMeasurements& radio, const JointGraph<Pose>& joint,
                                            const std::vector<FingerprintClosure>& closures) {
  std::vector<ClosureResult> results;
  for (std::size_t k = 0; k < closures.size(); ++k) {
    const auto& range = joint.graph.ranges[joint.first_closure_range + k];
    const auto keyframe_stamp = [&](std::size_t node) {
      const RobotVariables& variables = joint.robots[radio.nodes[node].robot.index()];
      return variables.stamps[keyframe_before(variables.stamps, radio.at(node).fingerprint.stamp)];
    };
    const double distance = (end_position(joint.graph, range.j) - end_position(joint.graph, range.i)).norm();
    ClosureResult result;
    result.robot_i = radio.nodes[closures[k].node_i].robot;
    result.stamp_i = keyframe_stamp(closures[k].node_i);
    result.robot_j = radio.nodes[closures[k].node_j].robot;
    result.stamp_j = keyframe_stamp(closures[k].node_j);
    result.kind = ClosureKind::kFingerprint;
    result.statistic = std::pow((distance - range.range_m) / range.sigma_m, 2);
    if (result.statistic > kAcceptedStatistic) {
      result.status = ClosureStatus::kRejected;
      result.reason = "the estimate disagrees";
    }
    results.push_back(std::move(result));
  }
  return results;
}

template <class Pose>
void add_uncertainty(std::vector<RobotResult>& robots, const JointGraph<Pose>& joint,
                     const Marginals<Pose>& marginals) {
  for (std::size_t r = 0; r < robots.size(); ++r)
    for (std::size_t k = 0; k < robots[r].estimate.size(); ++k) {
      const auto covariance = marginals.pose(PoseId(joint.robots[r].first_pose + k));
      const double trace = covariance.template topLeftCorner<Pose::kDim, Pose::kDim>().trace();
      robots[r].sigma_position_m.push_back(std::sqrt(std::max(0.0, trace) / Pose::kDim));
    }
}

template <class Pose>
std::vector<std::string> odometry_notes(const Mission& mission, const JointGraph<Pose>& joint,
                                        const Marginals<Pose>& marginals) {
  std::vector<std::string> notes;
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    const Robot& robot = mission.robots[r];
    const Eigen::Vector2d estimated = joint.graph.drifts[r].cwiseAbs();
    const Eigen::Vector2d sigma = marginals.drift(DriftId(r)).diagonal().cwiseMax(0).cwiseSqrt();
    const Eigen::Vector2d stated(robot.odometry_noise.sigma_yaw_drift_per_m_rad,
                                 robot.odometry_noise.sigma_scale);
    if (estimated[0] > kSurprise * std::max(stated[0], sigma[0]))
      notes.push_back("the odometry of " + robot.id + " turns by a constant drift beyond what it states");
    if (estimated[1] > kSurprise * std::max(stated[1], sigma[1]))
      notes.push_back("the odometry of " + robot.id +
                      " measures distances with an error beyond what it states");
  }
  return notes;
}

SimilarityModelResult collect_similarity_model(const RadioMeasurements& radio, const RadioParams& params) {
  SimilarityModelResult model;
  model.measure = params.measure;
  const double half_bin = params.distance_model.bin_width / 2;
  for (double s = half_bin; s < 1; s += 2 * half_bin)
    if (const auto p = radio.near_model.predict(s))
      model.bins.push_back({s, p->mean_m, p->sigma_m, p->samples});
  const auto& samples = radio.near_model.samples();
  const std::size_t stride = std::max<std::size_t>(1, samples.size() / kMostSamplesShown);
  for (std::size_t i = 0; i < samples.size(); i += stride)
    model.samples.emplace_back(samples[i].similarity, samples[i].distance_m);
  return model;
}

std::vector<Component> collect_components(const Mission& mission, const TeamFrame& team_frame) {
  std::vector<Component> components;
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    const auto c = static_cast<std::size_t>(team_frame.component[r]);
    if (components.size() <= c) components.resize(c + 1);
    components[c].robots.push_back(mission.robots[r].id);
  }
  return components;
}

template std::vector<RobotResult> collect_robots<SE2>(const Mission&, const JointGraph<SE2>&,
                                                      const TeamFrame&);
template std::vector<RobotResult> collect_robots<SE3>(const Mission&, const JointGraph<SE3>&,
                                                      const TeamFrame&);
template void add_uncertainty<SE2>(std::vector<RobotResult>&, const JointGraph<SE2>&, const Marginals<SE2>&);
template void add_uncertainty<SE3>(std::vector<RobotResult>&, const JointGraph<SE3>&, const Marginals<SE3>&);
template std::vector<std::string> odometry_notes<SE2>(const Mission&, const JointGraph<SE2>&,
                                                      const Marginals<SE2>&);
template std::vector<std::string> odometry_notes<SE3>(const Mission&, const JointGraph<SE3>&,
                                                      const Marginals<SE3>&);
template std::vector<ClosureResult> collect_closures<SE2>(const RadioMeasurements&, const JointGraph<SE2>&,
                                                          const std::vector<FingerprintClosure>&);
template std::vector<ClosureResult> collect_closures<SE3>(const RadioMeasurements&, const JointGraph<SE3>&,
                                                          const std::vector<FingerprintClosure>&);

}  // namespace radioslam
