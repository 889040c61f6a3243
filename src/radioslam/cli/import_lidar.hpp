// radioslam import carmen, kitti, rosbag: what robots with laser scanners recorded becomes a mission. Each
// source is one robot's.
#pragma once

#include "radioslam/cli/import_options.hpp"

namespace radioslam::cli {

void import_carmen_logs(const ImportOptions& options);

void import_kitti_drives(const ImportOptions& options);

/// Or lists the topics.
void import_ros_recordings(const ImportOptions& options);

}  // namespace radioslam::cli
