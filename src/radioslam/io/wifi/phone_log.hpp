// Reads logs of the site survey app of the Indoor Location Competition 2.0 (Android): one record per line,
// fields separated by tabs, `#` comments.
//
//   <ms>  TYPE_ACCELEROMETER | TYPE_GYROSCOPE | TYPE_ROTATION_VECTOR  x  y  z  accuracy
//   <ms>  TYPE_WAYPOINT  x  y            metres on the floor plan, x east, y north
//   <ms>  TYPE_WIFI  ssid  bssid  rssi_dbm  frequency_mhz  last_seen_ms
//   #  startTime:<ms> ...
//
// Times are Unix times in milliseconds; 16 or 19 digits are micro- or nanoseconds, a fraction means seconds.
// Records of other types (TYPE_...) are skipped. The rotation vector is the vector part of the unit
// quaternion from device to east-north-up, whose scalar part is positive. Other lines, truncated ones, and
// lines without a line break between them cost the records in them; records of one sensor that are out of
// order by at most a second are sorted (skipped_records.hpp). Network names may contain any bytes but line
// ends.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/io/text/skipped_records.hpp"
#include "radioslam/io/text/text.hpp"
#include "radioslam/mission/phone_motion.hpp"

namespace radioslam {

/// A position that the surveyor marked on the floor plan while passing it.
struct Waypoint {
  Stamp stamp;
  Eigen::Vector2d position_m;
};

/// One access point in a scan result. Phones also list access points of earlier scans.
struct ScanEntry {
  Stamp scan;       ///< time of the result, the same for all its entries
  Stamp last_seen;  ///< when this access point was received
  std::string bssid;
  float frequency_mhz = 0;
  float rssi_dbm = 0;
};

/// The log of one walk.
struct PhoneLog {
  Stamp start;            ///< of the recording if stated, otherwise of the first record
  Stamp begin, end;       ///< interval of all records and the start; begin < end
  bool complete = false;  ///< the log has an end time, so the recording is not truncated
  PhoneMotion motion;
  std::vector<Waypoint> waypoints;  ///< in time order
  std::vector<ScanEntry> wifi;      ///< scans in time order
  std::vector<std::string> warnings;
};

/// Sorts the records of each kind. Those that are out of order by more than is sorted are left out and added
/// to `skipped`; second waypoints of one time are left out.
void sort_phone_records(PhoneLog& log, const std::string& name, SkippedRecords& skipped);

/// Whether a text begins as such a log does.
bool is_phone_log(const Text& text);

/// Refuses (InputError) a log of which most records are malformed, and one without accelerometer or gyroscope
/// records or of a single time.
PhoneLog read_phone_log(const Text& text);

}  // namespace radioslam
