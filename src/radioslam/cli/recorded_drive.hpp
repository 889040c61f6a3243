// A drive that was recorded, from two files in KITTI's format.
#pragma once

#include <string>

#include "radioslam/sim/kitti.hpp"

namespace radioslam::cli {

/// True poses and odometry, a pose per line. `call` stands before a refusal: a missing file name, files of
/// different lengths, too few poses to be cut in two, and what read_kitti_poses refuses.
RecordedDrive read_drive(const std::string& call, const std::string& trajectory, const std::string& odometry);

}  // namespace radioslam::cli
