// Odometry as recordings have it, in the form of a mission's.
#pragma once

#include <vector>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"

namespace radioslam {

/// Poses relative to the first one's position and yaw; its roll and pitch stay.
Trajectory<SE3> from_start(std::vector<StampedPose<SE3>> poses);

/// Whether the trajectory climbs less than 0.1 m and tilts less than 5 degrees.
bool is_in_plane(const Trajectory<SE3>& poses);

}  // namespace radioslam
