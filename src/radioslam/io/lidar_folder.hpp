// A robot's scans: a folder with one file per scan, named after the scan's stamp in whole nanoseconds:
// <t_ns>.bin, float32 x y z intensity in little-endian order, or <t_ns>.pcd (pcd.hpp).
#pragma once

#include <filesystem>

#include "radioslam/mission/lidar.hpp"

namespace radioslam {

/// The scans of a folder, whose files are read when they are asked for; nothing without such a folder. Other
/// files are ignored. Refuses (InputError) at once a .bin or .pcd with another name, two scans of one stamp
/// and a .bin that is not a whole number of points (none is fine); on reading, a .pcd that is none.
LidarLog read_lidar_folder(const std::filesystem::path& folder);

/// One file of such a folder.
LidarScan read_lidar_file(const std::filesystem::path& file, Stamp stamp);

/// Writes one scan after the other: .bin with intensity 0; .pcd where the points have times.
void write_lidar_folder(const std::filesystem::path& folder, const LidarLog& log);

/// Writes one scan into such a folder.
void write_lidar_scan(const std::filesystem::path& folder, Stamp stamp, const LidarScan& scan);

}  // namespace radioslam
