// radioslam import carmen, kitti, rosbag: converts recordings with LiDAR scans to a mission. Each source is
// one robot.
#pragma once

#include "radioslam/cli/import/import_options.hpp"

namespace radioslam::cli {

void import_carmen_logs(const ImportOptions& options);

void import_kitti_drives(const ImportOptions& options);

/// Imports ROS recordings, or only lists their topics (--list).
void import_ros_recordings(const ImportOptions& options);

}  // namespace radioslam::cli
