// Reads trajectories of the KITTI odometry benchmark (Geiger et al. 2012): twelve numbers per line, the rows
// of [R t]. There are no stamps; line k gets k / 10 s. The frames are those of the file.
#pragma once

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/io/text/line_fields.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {

inline constexpr double kKittiFrequency_hz = 10;

/// Reads the next twelve numbers of a line. Refuses a matrix that is not a rotation up to rounding.
SE3 read_kitti_matrix(LineFields& fields);

/// Refuses (InputError) a matrix that is not a rotation up to rounding, and a text without poses.
Trajectory<SE3> read_kitti_poses(const Text& text);

}  // namespace radioslam
