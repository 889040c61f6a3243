// Imports what apps recorded on one phone: WiFi scans, and the odometry of its carrier from the motion
// sensors (mission/dead_reckoning.hpp).
//
// Sources are files and folders of files, recognised by their content:
//   tables of WiFi scans (wifi/scan_table.hpp)                          WiGLE, Sensor Logger, ...
//   tables of an accelerometer and a gyroscope (walker_tables.hpp)      Sensor Logger, Physics Toolbox, ...
//   one log of both (wifi/phone_log.hpp, wifi/sensor_data_log.hpp)      the site survey app, GetSensorData
// Of several tables of one sensor, the calibrated one with gravity is used. Other files are named in a note.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "radioslam/io/wifi/scan_table.hpp"
#include "radioslam/mission/dead_reckoning.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

struct AndroidParams {
  ScanTableParams scans;
  DeadReckoningParams walk;

  template <class Self, class Visitor>
  static void visit_sections(Self& self, Visitor&& visit) {
    visit("scans", self.scans);
    DeadReckoningParams::visit_sections(self.walk, visit);
  }
};

struct AndroidRecording {
  Robot robot;            ///< without a name and WiFi scans; without odometry if no motion was recorded
  Trajectory<SE3> truth;  ///< waypoints of a site survey; may be empty
  WifiLog wifi;           ///< may be empty if the robot has odometry
  std::size_t steps = 0;
  std::vector<std::string> warnings;
};

/// Refuses (InputError) whatever the readers refuse, a file that is given by name and none of the above, two
/// logs or two tables of one sensor, sources without anything to import, and scans of which none is within
/// the time of the motion.
AndroidRecording read_android_recording(const std::vector<std::filesystem::path>& sources,
                                        const AndroidParams& params);

}  // namespace radioslam
