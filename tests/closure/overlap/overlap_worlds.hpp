// Random teams for the overlap search: trajectories through one area with links between robots, as odometry
// chains and as a pose graph.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "graph/random_graphs.hpp"
#include "radioslam/closure/overlap/overlap_joint.hpp"
#include "radioslam/closure/overlap/overlap_link.hpp"
#include "radioslam/closure/overlap/overlap_search.hpp"

namespace radioslam::test {

template <class Pose>
struct OverlapWorld {
  std::vector<KeyframeOdometry<Pose>> chains;
  std::vector<OverlapLink<Pose>> links;
  std::vector<OverlapSensor> sensors;
  PoseGraph<Pose> graph;
  std::vector<ChainOfPoses> robots;
};

struct WorldSize {
  std::size_t robots = 2, poses = 150, links = 5;
  double step_m = 2, area_m = 60;
  double origin_m = 0;  ///< coordinate of the area's origin in the robots' frames
};

/// Random nearly level pose with random heading.
template <class Pose>
Pose heading_to(const typename Pose::Point& p, double yaw, Drawing<Pose>& draw) {
  if constexpr (Pose::kDim == 2)
    return Pose(p, yaw);
  else
    return lift(SE2(p.template head<2>(), yaw), p.z()) * draw.pose(0, 0.1);
}

/// Random trajectory that turns back into the area.
template <class Pose>
std::vector<Pose> walk_in_area(Drawing<Pose>& draw, const WorldSize& size) {
  std::vector<Pose> poses;
  typename Pose::Point p = draw.point(size.area_m / 3);
  if constexpr (Pose::kDim == 3) p.z() *= 0.1;
  double yaw = draw.rng.uniform(-3, 3);
  for (std::size_t k = 0; k < size.poses; ++k) {
    typename Pose::Point far = Pose::Point::Zero();
    far[0] = size.origin_m;
    poses.push_back(heading_to<Pose>(far + p, yaw, draw));
    yaw += draw.rng.normal(0, 0.15) + (p.norm() > size.area_m ? 0.3 : 0);
    p.x() += size.step_m * std::cos(yaw);
    p.y() += size.step_m * std::sin(yaw);
  }
  return poses;
}

template <class Pose>
typename Pose::Jacobian step_covariance(Drawing<Pose>& draw) {
  typename Pose::Tangent sigma = draw.tangent(0.05, 0.004);
  const typename Pose::Jacobian mixed = Pose::exp(draw.tangent(0.3, 0.3)).adjoint();
  const typename Pose::Tangent squared = sigma.cwiseAbs2().array() + 1e-6;
  return mixed * squared.asDiagonal() * mixed.transpose();
}

template <class Pose>
typename Pose::Jacobian link_covariance(Drawing<Pose>& draw) {
  typename Pose::Tangent sigma;
  for (int i = 0; i < Pose::kDof; ++i) sigma[i] = i < Pose::kDim ? draw.rng.uniform(0.2, 1) : 0.1;
  const typename Pose::Tangent squared = sigma.cwiseAbs2();
  return squared.asDiagonal();
}

/// Team as a pose graph: odometry with one drift per robot, the links, robust ranges between robots, and some
/// poses that are not searched.
template <class Pose>
void add_graph(OverlapWorld<Pose>& world, Drawing<Pose>& draw, bool with_ranges) {
  auto& graph = world.graph;
  std::vector<std::size_t> first;
  for (const auto& chain : world.chains) {
    first.push_back(graph.poses.size());
    world.robots.emplace_back();
    const DriftId drift(graph.drifts.size());
    graph.drifts.push_back(Drift(1e-4, 0.01));
    graph.drift_priors.push_back({drift, Drift::Zero(), Eigen::Vector2d(1e6, 2500).asDiagonal()});
    for (std::size_t k = 0; k < chain.poses.size(); ++k) {
      world.robots.back().poses.push_back(PoseId(graph.poses.size()));
      graph.poses.push_back(chain.poses[k]);
      if (k == 0) continue;
      RelativePoseFactor<Pose> f{PoseId(graph.poses.size() - 2), PoseId(graph.poses.size() - 1), {}};
      f.T_i_j = chain.poses[k - 1].inverse() * chain.poses[k] * draw.pose(0.02, 0.002);
      f.information = chain.cov_steps[k - 1].inverse();
      f.drift = drift;
      f.drift_jacobian(Pose::kDof - 1, 0) = 2;
      f.drift_jacobian(0, 1) = 2;
      graph.relative_poses.push_back(f);
    }
  }
  for (const auto& link : world.links) {
    RelativePoseFactor<Pose> f{
        PoseId(first[link.robot_a] + link.pose_a), PoseId(first[link.robot_b] + link.pose_b), {}};
    f.T_i_j = link.T_a_b;
    f.information = link.covariance.inverse();
    graph.relative_poses.push_back(f);
  }
  if (!with_ranges) return;
  for (std::size_t n = 0; n < 2 * world.links.size(); ++n) {
    const std::size_t i = draw.rng.below(world.chains[0].poses.size()),
                      j = draw.rng.below(world.chains[1].poses.size());
    RangeFactor<Pose> range{{PoseId(first[0] + i), {}, draw.point(0.2)},
                            {PoseId(first[1] + j), {}, draw.point(0.2)}};
    range.range_m =
        (graph.poses[first[0] + i].translation() - graph.poses[first[1] + j].translation()).norm() +
        draw.rng.normal();
    range.sigma_m = 0.5;
    range.loss = {LossKind::kCauchy, 1};
    graph.ranges.push_back(range);
  }
}

/// All robots' poses are in one frame here, as the graph's values require.
template <class Pose>
OverlapWorld<Pose> draw_world(std::uint64_t seed, const WorldSize& size, bool with_ranges = true) {
  Drawing<Pose> draw(seed);
  OverlapWorld<Pose> world;
  for (std::size_t r = 0; r < size.robots; ++r) {
    KeyframeOdometry<Pose> chain{walk_in_area(draw, size), {}, {}};
    for (std::size_t k = 1; k < size.poses; ++k) chain.cov_steps.push_back(step_covariance(draw));
    world.chains.push_back(chain);
    world.sensors.push_back({draw.rng.uniform(4, 10)});
  }
  for (std::size_t n = 0; n < size.links; ++n)
    for (std::size_t r = 1; r < size.robots; ++r) {
      OverlapLink<Pose> link{r - 1, draw.rng.below(size.poses), r, draw.rng.below(size.poses), {}};
      if (n % 2 == 1) std::swap(link.robot_a, link.robot_b);
      link.T_a_b = world.chains[link.robot_a].poses[link.pose_a].inverse() *
                   world.chains[link.robot_b].poses[link.pose_b] * draw.pose(0.3, 0.05);
      link.covariance = link_covariance(draw);
      world.links.push_back(link);
    }
  add_graph(world, draw, with_ranges);
  return world;
}

}  // namespace radioslam::test
