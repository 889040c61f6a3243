// Gravity along a trajectory in space. Odometry states no noise of roll and pitch: they come from gravity and
// do not drift. Their error is a Gauss-Markov process of standard deviation sigma_level: the random walk of
// the edges, of variance q between two priors, and priors of information q / (P (P + q)), P = sigma_level^2,
// which keep its variance at P. Without them the walk would lift the end of a kilometre by a hundred metres.
#pragma once

#include <cstddef>

#include "radioslam/graph/pose_graph.hpp"
#include "radioslam/mission/keyframes.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// Adds the priors of one robot's trajectory: of its first pose unless the start is known, and of later ones
/// unless the noise of the odometry was measured step by step, roll and pitch included. None in the plane.
void add_level_priors(PoseGraph<SE2>& graph, const Robot& robot, const RobotNodes& nodes,
                      std::size_t first_pose, double sigma_level_rad);
void add_level_priors(PoseGraph<SE3>& graph, const Robot& robot, const RobotNodes& nodes,
                      std::size_t first_pose, double sigma_level_rad);

}  // namespace radioslam
