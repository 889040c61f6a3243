#include "radioslam/joint/robot_nodes.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/base/check.hpp"
#include "radioslam/mission/odometry_edge.hpp"

namespace radioslam {
namespace {

Trajectory<SE3> with_stamps(const Trajectory<SE3>& odometry, const std::vector<Stamp>& node_stamps) {
  std::vector<StampedPose<SE3>> rows(odometry.begin(), odometry.end());
  for (const Stamp node_stamp : node_stamps) rows.push_back({node_stamp, *odometry.at(node_stamp)});
  std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
  rows.erase(
      std::unique(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.stamp == b.stamp; }),
      rows.end());
  return Trajectory<SE3>(std::move(rows));
}

}  // namespace

std::size_t RobotNodes::node_at(Stamp stamp) const {
  const auto found = std::lower_bound(stamps.begin(), stamps.end(), stamp);
  RADIOSLAM_CHECK(found != stamps.end() && *found == stamp, "every link within the odometry has a node");
  return static_cast<std::size_t>(found - stamps.begin());
}

RobotNodes nodes_at(const Trajectory<SE3>& odometry, std::vector<Stamp> stamps) {
  std::sort(stamps.begin(), stamps.end());
  stamps.erase(std::unique(stamps.begin(), stamps.end()), stamps.end());
  RobotNodes nodes;
  nodes.odometry = with_stamps(odometry, stamps);
  nodes.stamps = std::move(stamps);
  for (std::size_t row = 0, n = 0; n < nodes.stamps.size(); ++row)
    if (nodes.odometry[row].stamp == nodes.stamps[n]) nodes.rows.push_back(row), ++n;
  return nodes;
}

RobotNodes select_nodes(const Trajectory<SE3>& odometry, std::vector<Stamp> node_stamps,
                        const KeyframeParams& params) {
  std::erase_if(node_stamps, [&](Stamp node_stamp) { return !odometry.covers(node_stamp); });
  std::vector<Stamp> keyframes;
  for (const std::size_t row : refined_keyframes(odometry, select_keyframes(odometry, params), params))
    keyframes.push_back(odometry[row].stamp);
  node_stamps.insert(node_stamps.end(), keyframes.begin(), keyframes.end());
  RobotNodes nodes = nodes_at(odometry, std::move(node_stamps));
  for (const Stamp keyframe : keyframes) nodes.keyframes.push_back(nodes.node_at(keyframe));
  return nodes;
}

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
