#include "radioslam/joint/uncertainty/position_uncertainty.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "radioslam/base/statistics.hpp"
#include "radioslam/geometry/alignment.hpp"
#include "radioslam/graph/team_gauge.hpp"
#include "radioslam/team_frame/measurement_mixture.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMinLinks = 6;    // fewer may all be obstructed by chance
constexpr std::size_t kMinInSight = 3;  // as many as fix x, y and heading

struct LinkCounts {
  std::size_t links = 0, in_sight = 0, other_closures = 0;
};

LinkCounts count_links(RobotIndex robot, const std::vector<ClosureResult>& closures) {
  LinkCounts counts;
  for (const ClosureResult& closure : closures) {
    if (closure.robot_i == closure.robot_j || (closure.robot_i != robot && closure.robot_j != robot))
      continue;
    const bool is_accepted = closure.status == ClosureStatus::kAccepted;
    const bool is_link = closure.kind == ClosureKind::kRange || closure.kind == ClosureKind::kAoa;
    if (is_link) ++counts.links;
    if (is_accepted) ++(is_link ? counts.in_sight : counts.other_closures);
  }
  return counts;
}

}  // namespace

std::vector<std::string> notes_on_obstructed_robots(const std::vector<RobotResult>& robots,
                                                    const std::vector<ClosureResult>& closures) {
  std::vector<std::string> notes;
  for (std::size_t r = 0; r < robots.size(); ++r) {
    if (!robots[r].placed || robots[r].start_known) continue;
    const LinkCounts counts = count_links(RobotIndex(r), closures);
    if (counts.links < kMinLinks || counts.in_sight >= kMinInSight || counts.other_closures > 0) continue;
    notes.push_back("the place of robot " + robots[r].id + " is uncertain: " +
                    std::to_string(counts.in_sight) + " of its " + std::to_string(counts.links) +
                    " ranges and angles to other robots agree with it, the others are detours or false");
  }
  return notes;
}

namespace {

constexpr double kRejectedThere = 0.95;
constexpr double kMaxUsualShare = 0.75;  // a kind rejected more often says nothing
constexpr double kMinUsualShare = 0.05;
constexpr double kMinScore = 20;  // of a stretch; closures of one scan share errors
constexpr double kMinDuration_s = 30;

struct ScoredStatus {
  Stamp stamp;
  double score = 0;
};

/// Scores of a rejected and an accepted closure of a kind; both 0 where the kind says nothing.
struct KindScores {
  double rejected = 0, accepted = 0;
};

std::array<KindScores, kClosureKinds> kind_scores(const std::vector<ClosureResult>& closures) {
  std::array<std::size_t, kClosureKinds> all{}, rejected{};
  for (const ClosureResult& closure : closures) {
    const auto kind = static_cast<std::size_t>(closure.kind);
    ++all[kind];
    rejected[kind] += closure.status == ClosureStatus::kRejected ? 1U : 0U;
  }
  std::array<KindScores, kClosureKinds> scores;
  for (std::size_t kind = 0; kind < kClosureKinds; ++kind) {
    if (all[kind] == 0) continue;
    const double usual =
        std::max(kMinUsualShare, static_cast<double>(rejected[kind]) / static_cast<double>(all[kind]));
    if (usual > kMaxUsualShare) continue;
    scores[kind] = {std::log(kRejectedThere / usual), std::log((1 - kRejectedThere) / (1 - usual))};
  }
  return scores;
}

/// The statuses of one robot's closures, in time order.
std::vector<ScoredStatus> scored_statuses(RobotIndex robot, const std::vector<ClosureResult>& closures,
                                          const std::array<KindScores, kClosureKinds>& scores) {
  std::vector<ScoredStatus> result;
  for (const ClosureResult& closure : closures) {
    const KindScores& kind = scores[static_cast<std::size_t>(closure.kind)];
    const double score = closure.status == ClosureStatus::kRejected ? kind.rejected : kind.accepted;
    if (closure.robot_i == robot) result.push_back({closure.stamp_i, score});
    if (closure.robot_j == robot) result.push_back({closure.stamp_j, score});
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const ScoredStatus& x, const ScoredStatus& y) { return x.stamp < y.stamp; });
  return result;
}

/// Adds the interval of largest sum within [begin, end) if it is large enough, and those beside it.
void add_stretches(const std::vector<ScoredStatus>& of, std::size_t begin, std::size_t end,
                   std::vector<std::pair<Stamp, Stamp>>& stretches) {
  double sum = 0, best = 0;
  std::size_t from = begin, best_from = begin, best_to = begin;
  for (std::size_t k = begin; k < end; ++k) {
    if (sum <= 0) sum = 0, from = k;
    sum += of[k].score;
    if (sum > best) best = sum, best_from = from, best_to = k + 1;
  }
  if (best < kMinScore) return;
  add_stretches(of, begin, best_from, stretches);
  if (seconds_between(of[best_from].stamp, of[best_to - 1].stamp) >= kMinDuration_s)
    stretches.emplace_back(of[best_from].stamp, of[best_to - 1].stamp);
  add_stretches(of, best_to, end, stretches);
}

}  // namespace

std::vector<std::vector<std::pair<Stamp, Stamp>>> rejected_stretches(
    std::size_t robots, const std::vector<ClosureResult>& closures) {
  const auto scores = kind_scores(closures);
  std::vector<std::vector<std::pair<Stamp, Stamp>>> result(robots);
  for (std::size_t r = 0; r < robots; ++r) {
    const auto of_robot = scored_statuses(RobotIndex(r), closures, scores);
    add_stretches(of_robot, 0, of_robot.size(), result[r]);
  }
  return result;
}

template <class Pose>
JointGraph<Pose> graph_for_covariances(const JointGraph<Pose>& joint, const MixtureParams& mixture) {
  JointGraph<Pose> result = joint;
  use_observed_information(result.team.graph, factors_of(joint.origins.ranges, FactorSource::kRange),
                           mixture.sigma_antenna_position_m);
  return result;
}

template JointGraph<SE2> graph_for_covariances(const JointGraph<SE2>&, const MixtureParams&);
template JointGraph<SE3> graph_for_covariances(const JointGraph<SE3>&, const MixtureParams&);

namespace {

/// Share of the time that each keyframe stands for: trajectories are compared at equal steps of time.
std::vector<double> time_weights(const std::vector<Stamp>& stamps) {
  constexpr double kLeast_s = 1e-6, kHalf = 0.5;
  std::vector<double> weights;
  for (std::size_t k = 0; k < stamps.size(); ++k) {
    const Stamp first = stamps[k == 0 ? 0 : k - 1], last = stamps[std::min(k + 1, stamps.size() - 1)];
    weights.push_back(std::max(kLeast_s, kHalf * seconds_between(first, last)));
  }
  return weights;
}

/// The keyframes of the robots of one component, in their order.
struct ComponentKeyframes {
  std::vector<std::size_t> robots;
  std::vector<PoseId> poses;
  std::vector<double> weights;
};

template <class Pose>
std::vector<ComponentKeyframes> component_keyframes(const JointGraph<Pose>& joint,
                                                    const TeamAlignment<Pose>& alignment) {
  std::vector<ComponentKeyframes> components;
  for (std::size_t r = 0; r < joint.robots.size(); ++r) {
    const auto c = static_cast<std::size_t>(alignment.component[r]);
    if (components.size() <= c) components.resize(c + 1);
    const RobotVariables& robot = joint.robots[r];
    const std::vector<double> weights = time_weights(robot.stamps);
    components[c].robots.push_back(r);
    components[c].poses.insert(components[c].poses.end(), robot.poses.begin(), robot.poses.end());
    components[c].weights.insert(components[c].weights.end(), weights.begin(), weights.end());
  }
  return components;
}

/// Root of the mean variance per axis.
template <class Matrix>
double sigma_of(const Matrix& covariance) {
  return std::sqrt(std::max(0.0, covariance.trace()) / static_cast<double>(covariance.rows()));
}

/// Positions of the poses, one column each.
template <class Pose>
Eigen::Matrix<double, Pose::kDim, Eigen::Dynamic> positions(const std::vector<Pose>& poses,
                                                            const std::vector<PoseId>& of) {
  Eigen::Matrix<double, Pose::kDim, Eigen::Dynamic> result(Pose::kDim, static_cast<Eigen::Index>(of.size()));
  for (std::size_t k = 0; k < of.size(); ++k)
    result.col(static_cast<Eigen::Index>(k)) = poses[of[k].index()].translation();
  return result;
}

/// Adds to each keyframe's variance; `added` in the order of the component's keyframes.
void add_variances(std::vector<RobotResult>& robots, const ComponentKeyframes& component,
                   const Eigen::VectorXd& added_m2) {
  Eigen::Index k = 0;
  for (const std::size_t r : component.robots)
    for (double& sigma : robots[r].sigma_team_m) sigma = std::sqrt(sigma * sigma + added_m2[k++]);
}

/// The alternative's positions moved onto the estimate's, as squared distances per axis.
template <class Pose>
Eigen::VectorXd squared_distances(const std::vector<Pose>& estimate, const std::vector<Pose>& alternative,
                                  const ComponentKeyframes& component) {
  const auto target = positions(estimate, component.poses), source = positions(alternative, component.poses);
  const Eigen::VectorXd weights = Eigen::Map<const Eigen::VectorXd>(
      component.weights.data(), static_cast<Eigen::Index>(component.weights.size()));
  const Pose T = align_points(source, target, weights);
  Eigen::VectorXd result(source.cols());
  for (Eigen::Index k = 0; k < source.cols(); ++k)
    result[k] = (target.col(k) - T * typename Pose::Point(source.col(k))).squaredNorm() / Pose::kDim;
  return result;
}

/// The factor by which distances and angles at a robot's keyframes in a stretch miss what is stated: the root
/// of their median squared residual, at least 1.
double excess_of_residuals(RobotIndex robot, const std::pair<Stamp, Stamp>& stretch,
                           const std::vector<ClosureResult>& closures) {
  const Stamp first = stretch.first, last = stretch.second;
  std::vector<double> squares{1};
  for (const ClosureResult& closure : closures) {
    const bool is_scalar = closure.kind == ClosureKind::kRange || closure.kind == ClosureKind::kAoa ||
                           closure.kind == ClosureKind::kFingerprint;
    const auto lies = [&](RobotIndex r, Stamp t) { return r == robot && !(t < first) && !(last < t); };
    if (is_scalar && (lies(closure.robot_i, closure.stamp_i) || lies(closure.robot_j, closure.stamp_j)))
      squares.push_back(closure.statistic);
  }
  return std::max(1.0, std::sqrt(upper_median(std::move(squares))));
}

}  // namespace

template <class Pose>
void add_uncertainty(std::vector<RobotResult>& robots, const JointGraph<Pose>& joint,
                     const TeamAlignment<Pose>& alignment, const Marginals<Pose>& marginals) {
  for (std::size_t r = 0; r < robots.size(); ++r)
    for (const PoseId i : joint.robots[r].poses)
      robots[r].sigma_position_m.push_back(
          sigma_of(marginals.pose(i).template topLeftCorner<Pose::kDim, Pose::kDim>()));
  for (const ComponentKeyframes& component : component_keyframes(joint, alignment)) {
    const auto covariances = position_covariances_in_team_gauge(marginals, joint.team.graph.poses,
                                                                component.poses, component.weights);
    auto covariance = covariances.begin();
    for (const std::size_t r : component.robots)
      for (std::size_t k = 0; k < joint.robots[r].poses.size(); ++k)
        robots[r].sigma_team_m.push_back(sigma_of(*covariance++));
  }
}

template <class Pose>
void widen_by_alternatives(std::vector<RobotResult>& robots, const JointGraph<Pose>& joint,
                           const TeamAlignment<Pose>& alignment) {
  double weights = alignment.weight;
  for (const double weight : alignment.alternative_weights) weights += weight;
  const auto components = component_keyframes(joint, alignment);
  std::vector<Eigen::VectorXd> added;
  for (const ComponentKeyframes& component : components)
    added.push_back(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(component.poses.size())));
  for (std::size_t h = 0; h < alignment.alternatives.size(); ++h) {
    const double weight = alignment.alternative_weights[h] / weights;
    for (std::size_t c = 0; c < components.size(); ++c)
      added[c] +=
          weight * squared_distances(joint.team.graph.poses, alignment.alternatives[h], components[c]);
  }
  for (std::size_t c = 0; c < components.size(); ++c) add_variances(robots, components[c], added[c]);
}

void widen_by_rejected_closures(std::vector<RobotResult>& robots,
                                const std::vector<ClosureResult>& closures) {
  for (std::size_t r = 0; r < robots.size(); ++r) {
    RobotResult& robot = robots[r];
    for (const auto& stretch : robot.uncertain) {
      const double ratio = excess_of_residuals(RobotIndex(r), stretch, closures);
      for (std::size_t k = 0; k < robot.sigma_position_m.size(); ++k) {
        const Stamp t = robot.estimate[k].stamp;
        if (t < stretch.first || stretch.second < t) continue;
        robot.sigma_position_m[k] *= ratio;
        robot.sigma_team_m[k] *= ratio;
      }
    }
  }
}

#define RADIOSLAM_UNCERTAINTY(Pose)                                                       \
  template void add_uncertainty(std::vector<RobotResult>&, const JointGraph<Pose>&,       \
                                const TeamAlignment<Pose>&, const Marginals<Pose>&);      \
  template void widen_by_alternatives(std::vector<RobotResult>&, const JointGraph<Pose>&, \
                                      const TeamAlignment<Pose>&);
RADIOSLAM_UNCERTAINTY(SE2)
RADIOSLAM_UNCERTAINTY(SE3)
#undef RADIOSLAM_UNCERTAINTY

namespace {

/// The robot's only segment; null if gaps in its odometry split its trajectory.
template <class Pose>
const TrajectorySegment* only_segment(const JointGraph<Pose>& joint, std::size_t robot) {
  const auto& owners = joint.robot_of_segment;
  if (std::count(owners.begin(), owners.end(), robot) != 1) return nullptr;
  return &joint.team.segments[static_cast<std::size_t>(std::find(owners.begin(), owners.end(), robot) -
                                                       owners.begin())];
}

template <class Pose>
EstimatedKeyframes<Pose> estimated_poses(const JointGraph<Pose>& joint, const TrajectorySegment& segment,
                                         const Pose& T_frame_graph, const Marginals<Pose>* marginals) {
  std::vector<StampedPose<Pose>> poses;
  EstimatedKeyframes<Pose> keyframes;
  for (std::size_t k = 0; k < segment.pose_count; ++k) {
    const PoseId id(segment.first_pose + k);
    poses.push_back({segment.stamps[k], T_frame_graph * joint.team.graph.poses[id.index()]});
    if (marginals && k > 0)
      keyframes.covariances.push_back(
          marginals->joint(variable(PoseId(segment.first_pose + k - 1)), variable(id)));
  }
  keyframes.poses = Trajectory<Pose>(std::move(poses));
  return keyframes;
}

template <class Pose>
double sigma_position(const UncertainPose<Pose>& pose) {
  const double trace = pose.covariance.template topLeftCorner<Pose::kDim, Pose::kDim>().trace();
  return std::sqrt(std::max(0.0, trace) / Pose::kDim);
}

}  // namespace

template <class Pose>
std::optional<ContinuousTrajectory<Pose>> continuous_trajectory(const Mission& mission,
                                                                const JointGraph<Pose>& joint,
                                                                const Marginals<Pose>* marginals,
                                                                std::size_t robot,
                                                                const RobotResult& estimate) {
  const TrajectorySegment* segment = only_segment(joint, robot);
  const Robot& recorded = mission.robots[robot];
  const RobotVariables& of = joint.robots[robot];
  if (!segment || of.poses.empty() || !recorded.odometry.covers(segment->stamps.front()) ||
      !recorded.odometry.covers(segment->stamps.back()))
    return std::nullopt;
  const Pose T_frame_graph = pose_as<Pose>(estimate.estimate.front().pose) *
                             joint.team.graph.poses[of.poses.front().index()].inverse();
  auto keyframes = estimated_poses(joint, *segment, T_frame_graph, marginals);
  if (of.drift.valid()) keyframes.drift = joint.team.graph.drifts[of.drift.index()];
  return ContinuousTrajectory<Pose>(recorded, std::move(keyframes));
}

template <class Pose>
DenseTrajectory dense_trajectory(const Mission& mission, const JointGraph<Pose>& joint,
                                 const Marginals<Pose>* marginals, std::size_t robot,
                                 const RobotResult& estimate, const std::vector<Stamp>& stamps) {
  DenseTrajectory dense{estimate.id, {}, {}};
  const auto trajectory = continuous_trajectory(mission, joint, marginals, robot, estimate);
  if (!trajectory) return dense;
  std::vector<Stamp> covered;
  std::copy_if(stamps.begin(), stamps.end(), std::back_inserter(covered),
               [&](Stamp stamp) { return trajectory->covers(stamp); });
  const auto poses = trajectory->at(covered);
  std::vector<StampedPose<SE3>> rows;
  for (std::size_t k = 0; k < covered.size(); ++k) {
    const double z_m = mission.robots[robot].odometry.at(covered[k])->translation().z();
    rows.push_back({covered[k], as_se3(poses[k].pose, z_m)});
    if (marginals) dense.sigma_position_m.push_back(sigma_position(poses[k]));
  }
  dense.poses = Trajectory<SE3>(std::move(rows));
  return dense;
}

template <class Pose>
DenseTrajectory dense_trajectory(const Mission& mission, const JointGraph<Pose>& joint,
                                 const Marginals<Pose>* marginals, std::size_t robot,
                                 const RobotResult& estimate) {
  std::vector<Stamp> stamps;
  for (const auto& row : mission.robots[robot].odometry) stamps.push_back(row.stamp);
  return dense_trajectory(mission, joint, marginals, robot, estimate, stamps);
}

#define RADIOSLAM_DENSE_TRAJECTORY(Pose)                                                                     \
  template std::optional<ContinuousTrajectory<Pose>> continuous_trajectory(                                  \
      const Mission&, const JointGraph<Pose>&, const Marginals<Pose>*, std::size_t, const RobotResult&);     \
  template DenseTrajectory dense_trajectory(const Mission&, const JointGraph<Pose>&, const Marginals<Pose>*, \
                                            std::size_t, const RobotResult&, const std::vector<Stamp>&);     \
  template DenseTrajectory dense_trajectory(const Mission&, const JointGraph<Pose>&, const Marginals<Pose>*, \
                                            std::size_t, const RobotResult&);
RADIOSLAM_DENSE_TRAJECTORY(SE2)
RADIOSLAM_DENSE_TRAJECTORY(SE3)
#undef RADIOSLAM_DENSE_TRAJECTORY

}  // namespace radioslam
