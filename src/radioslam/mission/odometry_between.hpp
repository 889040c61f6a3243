// Odometry between any two times with its full covariance: the random walk of odometry_edge.hpp and the
// priors of constant drift and scale error.
#pragma once

#include <vector>

#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/mission/odometry_edge.hpp"

namespace radioslam {

/// T_from_to with its covariance, for either order of the times, both of which the odometry must cover.
/// Cost: linear in the samples between them.
template <class Pose>
UncertainPose<Pose> odometry_between(const Robot& robot, Stamp from, Stamp to);

/// T_start_body at each of these times, which must not decrease and be covered. Cost: linear in samples and
/// times.
template <class Pose>
std::vector<UncertainPose<Pose>> odometry_since_start(const Robot& robot, const std::vector<Stamp>& stamps);

}  // namespace radioslam
