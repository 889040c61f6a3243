// What odometry says of a robot's motion between any two times, with everything it states of its errors:
// the random walk of odometry_edge.hpp and the priors of its constant drift and scale.
#pragma once

#include <vector>

#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/mission/odometry_edge.hpp"

namespace radioslam {

/// T_from_to with its covariance, in either order of the times, both of which the odometry must cover.
/// Cost: the rows between them.
template <class Pose>
UncertainPose<Pose> odometry_between(const Robot& robot, Stamp from, Stamp to);

/// T_start_body at each of these times, which must not decrease and be covered. Cost: rows and times.
template <class Pose>
std::vector<UncertainPose<Pose>> odometry_since_start(const Robot& robot, const std::vector<Stamp>& stamps);

}  // namespace radioslam
