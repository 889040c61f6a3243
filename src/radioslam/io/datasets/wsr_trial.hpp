// Reads trials of the WSR data set (Harvard-REACT/WSR-Toolbox-Dataset): a robot with a radio drives an arc
// while up to three others answer its packets. A folder with groundtruth_positions.json has one or more
// trials, distinguished by the time in their file names:
//   csi_rx<time>.dat                    capture of the moving robot (intel5300.hpp)
//   csi_tx2|3|4<time>.dat               captures of the other robots; at least one
//   rx_trajectory<time>[_].csv          true antenna positions from motion capture
//   t265_rx_trajectory<time>[_].csv     trajectory of a tracking camera; may be missing
//   odom_rx_trajectory<time>[_].csv     wheel odometry of the centre of the base; may be missing
//   groundtruth_positions.json          WiFi channel, and positions of the other robots
// The tables have no header: seconds, nanoseconds, x, y, z[, qx, qy, qz, qw, ...], and may end in a comma.
// Whether there was a line of sight is given by the nearest parent folder whose name starts with LOS or NLOS.
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

/// The files of a trial.
struct WsrTrialFiles {
  std::string name;  ///< folder name and time
  WsrSight sight = WsrSight::kLineOfSight;
  std::filesystem::path positions, receiver, motion_capture;
  std::optional<std::filesystem::path> tracking_camera, wheel_odometry;
  std::vector<std::pair<std::string, std::filesystem::path>> transmitters;  ///< "tx2", capture
};

/// One of the static robots.
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
  std::optional<Trajectory<SE3>> wheel_odometry;   ///< of the centre of the base
  std::vector<std::string> warnings;               ///< rows left out and why
};

/// Finds all trials at any depth of a folder, sorted by name. Refuses (InputError) a folder without trials,
/// trials without motion capture or transmitters, ambiguous files, and folders outside LOS* and NLOS*.
std::vector<WsrTrialFiles> find_wsr_trials(const std::filesystem::path& folder);

/// Reads a trial. Rows out of order in time by at most a second are sorted, others and malformed ones are
/// left out with a warning. Refuses whatever the readers of its files and trajectory_of_rows refuse, unknown
/// channels and transmitters without a position.
WsrTrial read_wsr_trial(const WsrTrialFiles& files);

}  // namespace radioslam
