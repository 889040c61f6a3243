// The log of a site survey app on an Android phone (Indoor Location Competition 2.0, trace files): tabs,
// one record per line, `#` comments.
//
//   <ms>  TYPE_ACCELEROMETER | TYPE_GYROSCOPE | TYPE_ROTATION_VECTOR  x  y  z  accuracy
//   <ms>  TYPE_WAYPOINT  x  y            metres on the floor plan, x east, y north
//   <ms>  TYPE_WIFI  ssid  bssid  rssi_dbm  frequency_mhz  last_seen_ms
//   #  startTime:<ms> ...
//
// Times are milliseconds of the Unix epoch. Records of other types (TYPE_...) are skipped. The rotation
// vector is the vector part of the unit quaternion from device to east-north-up; its scalar part is positive.
// Rows of one sensor run forward in time. Refused with their line: anything else, lines glued together and
// torn ones.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/io/text.hpp"
#include "radioslam/mission/phone_motion.hpp"

namespace radioslam {

/// A place the walker marked on the floor plan while passing it.
struct Waypoint {
  Stamp stamp;
  Eigen::Vector2d position_m;
};

/// One access point in the result of one scan. Phones also list what they heard in earlier scans.
struct ScanEntry {
  Stamp scan;       ///< when the result came; the same for all its entries
  Stamp last_seen;  ///< when this access point was heard
  std::string bssid;
  float frequency_mhz = 0;
  float rssi_dbm = 0;
};

/// One walk's log.
struct PhoneLog {
  Stamp start;            ///< of the recording if the log says so, else the first record's
  Stamp begin, end;       ///< around all records and the start; begin < end
  bool complete = false;  ///< the app wrote its end time: the recording was not cut off
  PhoneMotion motion;
  std::vector<Waypoint> waypoints;  ///< in time order
  std::vector<ScanEntry> wifi;      ///< scans in time order
};

PhoneLog read_phone_log(const Text& text);

}  // namespace radioslam
