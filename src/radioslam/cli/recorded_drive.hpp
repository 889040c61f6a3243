// Reads a recorded drive (true poses and odometry) from two files in KITTI format.
#pragma once

#include <string>

#include "radioslam/sim/scenarios/kitti.hpp"

namespace radioslam::cli {

/// Reads one pose per line from each file. Refuses (InputError, prefixed by `call`) an empty file name; also
/// refuses files of different lengths, fewer poses than two robots need, and whatever read_kitti_poses
/// refuses.
RecordedDrive read_drive(const std::string& call, const std::string& trajectory, const std::string& odometry);

}  // namespace radioslam::cli
