// Reads and writes a robot's folder of LiDAR scans, one file per scan, named by its stamp in nanoseconds:
// <t_ns>.bin (float32 x y z intensity, little endian) or <t_ns>.pcd (pcd.hpp).
#pragma once

#include <cstdint>
#include <filesystem>

#include "radioslam/mission/lidar.hpp"

namespace radioslam {

/// Lists the scans of a folder, whose files are read on demand; empty if the folder does not exist. Other
/// files are ignored. Refuses (InputError) immediately a .bin or .pcd with another name, two scans with the
/// same stamp, and a .bin that is not a whole number of points (zero is accepted); refuses an invalid .pcd
/// and a .bin with another number of floats per point (bin_layout.hpp) when it is read.
LidarLog read_lidar_folder(const std::filesystem::path& folder);

/// Refuses (InputError) a .bin whose size is not a whole number of points.
void check_bin_size(const std::filesystem::path& file, std::uintmax_t bytes);

/// Reads one scan file of such a folder.
LidarScan read_lidar_file(const std::filesystem::path& file, Stamp stamp);

/// Writes all scans one by one: as .pcd if the points have times, otherwise as .bin; with intensity 0 where it
/// is unknown.
void write_lidar_folder(const std::filesystem::path& folder, const LidarLog& log);

/// Writes one scan into such a folder.
void write_lidar_scan(const std::filesystem::path& folder, Stamp stamp, const LidarScan& scan);

}  // namespace radioslam
