#include "radioslam/joint/uncertainty/position_uncertainty.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "radioslam/base/statistics.hpp"
#include "radioslam/geometry/alignment.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/graph/team_gauge.hpp"
#include "radioslam/team_frame/measurement_mixture.hpp"

namespace radioslam {

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

constexpr double kAnyHeading_rad = std::numbers::pi / std::numbers::sqrt3;  // standard deviation

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
  constexpr int kTurns = Pose::kDof - Pose::kDim;
  for (std::size_t r = 0; r < robots.size(); ++r)
    for (const PoseId i : joint.robots[r].poses) {
      const typename Pose::Jacobian covariance = marginals.pose(i);
      robots[r].sigma_position_m.push_back(
          sigma_of(covariance.template topLeftCorner<Pose::kDim, Pose::kDim>()));
      robots[r].sigma_rad.push_back(
          std::min(kAnyHeading_rad, sigma_of(covariance.template bottomRightCorner<kTurns, kTurns>())));
    }
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
void widen_by_unknown_motions(std::vector<RobotResult>& robots, const JointGraph<Pose>& joint,
                              const Marginals<Pose>& marginals) {
  constexpr double kUnknown_rad = 1, kTied_rad = 0.05;  // standard deviations of a heading
  const auto& poses = joint.team.graph.poses;
  for (const std::size_t f : factors_of(joint.origins.relative_poses, FactorSource::kOdometry)) {
    const RelativePoseFactor<Pose>& step = joint.team.graph.relative_poses[f];
    const typename Pose::Jacobian covariance = inverse(step.information);
    if (covariance(Pose::kDof - 1, Pose::kDof - 1) < kUnknown_rad * kUnknown_rad) continue;
    const typename Pose::Jacobian known = marginals.relative_pose(step.i, step.j);
    if (known(Pose::kDof - 1, Pose::kDof - 1) < kTied_rad * kTied_rad) continue;
    const double motion_m2 = covariance.template topLeftCorner<Pose::kDim, Pose::kDim>().trace() / Pose::kDim;
    const std::size_t r = joint.origins.relative_poses[f].robot_i.index();
    const std::vector<PoseId>& keyframes = joint.robots[r].poses;
    const auto behind =
        static_cast<std::size_t>(std::lower_bound(keyframes.begin(), keyframes.end(), step.j,
                                                  [](PoseId a, PoseId b) { return a.index() < b.index(); }) -
                                 keyframes.begin());
    const double share = static_cast<double>(behind) / static_cast<double>(keyframes.size());
    for (std::size_t k = 0; k < keyframes.size(); ++k) {
      const bool is_behind = k >= behind;
      const double arm_m =
          (poses[keyframes[k].index()].translation() - poses[step.j.index()].translation()).norm();
      const double added_m2 = motion_m2 + arm_m * arm_m;
      const auto widen = [&](double& sigma_m, double by) {
        sigma_m = std::sqrt(sigma_m * sigma_m + by * by * added_m2);
      };
      if (is_behind) {
        widen(robots[r].sigma_position_m[k], 1);
        robots[r].sigma_rad[k] = kAnyHeading_rad;
      }
      widen(robots[r].sigma_team_m[k], is_behind ? share : 1 - share);
    }
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

template <class Pose>
void widen_by_layout(std::vector<RobotResult>& robots, const TeamAlignment<Pose>& alignment) {
  for (std::size_t r = 0; r < alignment.sigma_layout_m.size(); ++r)
    for (auto* sigmas : {&robots[r].sigma_position_m, &robots[r].sigma_team_m})
      for (double& sigma : *sigmas) sigma = std::hypot(sigma, alignment.sigma_layout_m[r]);
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
        robot.sigma_rad[k] = std::min(kAnyHeading_rad, robot.sigma_rad[k] * ratio);
      }
    }
  }
}

#define RADIOSLAM_UNCERTAINTY(Pose)                                                          \
  template void add_uncertainty(std::vector<RobotResult>&, const JointGraph<Pose>&,          \
                                const TeamAlignment<Pose>&, const Marginals<Pose>&);         \
  template void widen_by_unknown_motions(std::vector<RobotResult>&, const JointGraph<Pose>&, \
                                         const Marginals<Pose>&);                            \
  template void widen_by_alternatives(std::vector<RobotResult>&, const JointGraph<Pose>&,    \
                                      const TeamAlignment<Pose>&);                           \
  template void widen_by_layout(std::vector<RobotResult>&, const TeamAlignment<Pose>&);
RADIOSLAM_UNCERTAINTY(SE2)
RADIOSLAM_UNCERTAINTY(SE3)
#undef RADIOSLAM_UNCERTAINTY

}  // namespace radioslam
