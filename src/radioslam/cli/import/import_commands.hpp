// The kinds of `radioslam import`.
#pragma once

#include "radioslam/cli/import/import_options.hpp"

namespace radioslam::cli {

// iw, iwlist, nmcli, airodump, pcap: output of WiFi tools to a robot's wifi.csv.

/// Imports scan lists printed by iw, iwlist or nmcli, from files or folders of files.
void import_printed_scans(const ImportOptions& options);
void import_airodump(const ImportOptions& options);
void import_wifi_captures(const ImportOptions& options);

/// iw-ftm: WiFi round-trip times to a ranges.csv.
void import_ftm_ranges(const ImportOptions& options);

// android: a phone's wifi.csv and odometry.tum.

void import_android(const ImportOptions& options);

// odometry; imu, waypoints (of a walker): a robot's odometry.tum.

void import_odometry(const ImportOptions& options);
void import_imu(const ImportOptions& options);
void import_waypoints(const ImportOptions& options);

// carmen, kitti, rosbag: recordings with LiDAR scans to a mission. Each source is one robot.

void import_carmen_logs(const ImportOptions& options);
void import_kitti_drives(const ImportOptions& options);
/// Imports ROS recordings, or only lists their topics (--list).
void import_ros_recordings(const ImportOptions& options);

// indoor-location, wifine, wifi-rtt, dpgo: public data sets to missions.

void import_phone_logs(const ImportOptions& options);
void import_wifine_trajectories(const ImportOptions& options);
void import_rtt_walk(const ImportOptions& options);
/// Writes a g2o file if the output ends in .g2o, else a mission.
void import_dpgo_tables(const ImportOptions& options);

}  // namespace radioslam::cli
