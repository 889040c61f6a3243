// Trials of the WSR data set (Harvard-REACT/WSR-Toolbox-Dataset): a robot with a radio drives an arc while up
// to three others answer its packets. A folder with groundtruth_positions.json has one or more trials, told
// apart by what their files' names share, the time:
//   csi_rx<time>.dat                    what the moving robot heard (intel5300.hpp)
//   csi_tx2|3|4<time>.dat               what the others heard of it; at least one
//   rx_trajectory<time>[_].csv          the antenna's true places, by motion capture
//   t265_rx_trajectory<time>[_].csv     a tracking camera's; may be missing
//   odom_rx_trajectory<time>[_].csv     wheel odometry of the base's centre; may be missing
//   groundtruth_positions.json          the channel's number, and where the others stood
// The tables have no header: seconds, nanoseconds, x, y, z[, qx, qy, qz, qw, ...], and may end in a comma.
// Whether the others were in sight is told by the nearest folder whose name starts with LOS or NLOS.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/mission/csi.hpp"

namespace radioslam {

enum class WsrSight { kLineOfSight, kNoLineOfSight };
enum class WsrMotion { kMotionCapture, kTrackingCamera, kWheelOdometry };

/// Where a trial's files lie.
struct WsrTrialFiles {
  std::string name;  ///< of the folder, and the time
  WsrSight sight = WsrSight::kLineOfSight;
  std::filesystem::path positions, receiver, motion_capture;
  std::optional<std::filesystem::path> tracking_camera, wheel_odometry;
  std::vector<std::pair<std::string, std::filesystem::path>> transmitters;  ///< "tx2", capture
};

/// One of those that stood.
struct WsrTransmitter {
  std::string name;
  MacAddress address;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  CsiCapture heard;
};

struct WsrTrial {
  std::string name;
  WsrSight sight = WsrSight::kLineOfSight;
  double carrier_hz = 0;
  CsiCapture receiver;
  std::vector<WsrTransmitter> transmitters;
  Trajectory<SE3> motion_capture;                  ///< of the antenna, without orientation
  std::optional<Trajectory<SE3>> tracking_camera;  ///< of the antenna
  std::optional<Trajectory<SE3>> wheel_odometry;   ///< of the base's centre
};

/// All trials at any depth of a folder, by name. Refuses (InputError) a folder without any, trials without
/// motion capture or without transmitters, two files for one purpose, and folders not in LOS* or NLOS*.
std::vector<WsrTrialFiles> find_wsr_trials(const std::filesystem::path& folder);

/// Refuses what the files' readers refuse, unknown channels, transmitters without a place, and rows that are
/// malformed or do not run forward in time.
WsrTrial read_wsr_trial(const WsrTrialFiles& files);

}  // namespace radioslam
