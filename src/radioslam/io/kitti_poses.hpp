// Trajectories of the KITTI odometry benchmark (Geiger et al. 2012): twelve numbers per line, the rows of
// [R t]; no stamps, so that line k is taken at k / 10 s. The frames are the file's own.
#pragma once

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/io/fields_of_line.hpp"
#include "radioslam/io/text.hpp"

namespace radioslam {

inline constexpr double kKittiFrequency_hz = 10;

/// The next twelve numbers of a line. Refuses a matrix that is no rotation up to rounding.
SE3 read_kitti_matrix(LineFields& fields);

/// Refuses a matrix that is no rotation up to rounding, and a text without poses.
Trajectory<SE3> read_kitti_poses(const Text& text);

}  // namespace radioslam
