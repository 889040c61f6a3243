#include "radioslam/team_frame/fingerprint_bodies.hpp"

#include <algorithm>

namespace radioslam {
namespace {

/// T_common_start of a robot whose first body pose is known.
SE2 start_from_initial_pose(const SE3& initial_pose, const Robot& robot) {
  return flatten(initial_pose) * flatten(robot.odometry.front().pose).inverse();
}

}  // namespace

std::vector<std::size_t> thinned_nodes(std::size_t count, int most) {
  const auto kept = static_cast<std::size_t>(most);
  const std::size_t stride = std::max<std::size_t>(1, (count + kept - 1) / kept);
  std::vector<std::size_t> nodes;
  for (std::size_t i = 0; i < count; i += stride) nodes.push_back(i);
  return nodes;
}

std::vector<RigidBody> fingerprint_bodies(const Mission& mission, const KnownStarts& starts,
                                          const RadioMeasurements& radio,
                                          const std::vector<std::size_t>& nodes) {
  std::vector<RigidBody> bodies(mission.robots.size());
  for (std::size_t r = 0, first = 0; r < bodies.size(); ++r) {
    const Robot& robot = mission.robots[r];
    std::vector<Eigen::Vector2d> points;
    for (const std::size_t node : nodes)
      if (radio.nodes[node].robot.index() == r)
        points.emplace_back(radio.at(node).T_start_body.translation().head<2>());
    bodies[r].first_node = first;
    bodies[r].points.resize(2, static_cast<Eigen::Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i)
      bodies[r].points.col(static_cast<Eigen::Index>(i)) = points[i];
    bodies[r].fixed = starts[r].has_value();
    if (bodies[r].fixed) bodies[r].T_layout_body = start_from_initial_pose(*starts[r], robot);
    if (robot.heading == Heading::kAbsolute) bodies[r].sigma_heading_rad = robot.sigma_heading_rad;
    first += points.size();
  }
  return bodies;
}

}  // namespace radioslam
