#include "radioslam/joint/level_priors.hpp"

#include <cmath>

#include "radioslam/mission/odometry_edge.hpp"

namespace radioslam {
namespace {

constexpr double kWalkPerPrior = 0.25;  // of the level's variance: sparse priors keep the graph compressible

/// Mean variance per axis that an edge adds to roll and pitch.
double tilt_variance(const OdometryEdge<SE3>& edge) {
  const SE3::Jacobian& c = edge.covariance;
  return (c(3, 3) + c(4, 4)) / 2;
}

/// Prior that the pose is tilted as by the odometry.
PosePriorFactor<SE3> gravity_prior(PoseId i, const SE3& T_start_body, double sigma_rad) {
  PosePriorFactor<SE3> prior;
  prior.i = i;
  prior.prior = T_start_body;
  prior.information.setZero();
  prior.information.diagonal().tail<3>().setConstant(1 / (sigma_rad * sigma_rad));
  prior.gravity_only = true;
  return prior;
}

}  // namespace

void add_level_priors(PoseGraph<SE2>& /*graph*/, const Robot& /*robot*/, const RobotNodes& /*nodes*/,
                      std::size_t /*first_pose*/, double /*sigma_level_rad*/) {}

void add_level_priors(PoseGraph<SE3>& graph, const Robot& robot, const RobotNodes& nodes,
                      std::size_t first_pose, double sigma_level_rad) {
  if (!robot.initial_pose)
    graph.pose_priors.push_back(
        gravity_prior(PoseId(first_pose), nodes.odometry[nodes.rows.front()].pose, sigma_level_rad));
  if (!robot.odometry_noise.steps.empty()) return;
  const double level = sigma_level_rad * sigma_level_rad;
  double walk = 0;
  for (std::size_t n = 1; n < nodes.rows.size(); ++n) {
    walk += tilt_variance(
        odometry_edge<SE3>(nodes.odometry, nodes.rows[n - 1], nodes.rows[n], robot.odometry_noise));
    if (walk < kWalkPerPrior * level) continue;
    const double sigma = std::sqrt(level * (level + walk) / walk);
    graph.pose_priors.push_back(
        gravity_prior(PoseId(first_pose + n), nodes.odometry[nodes.rows[n]].pose, sigma));
    walk = 0;
  }
}

}  // namespace radioslam
