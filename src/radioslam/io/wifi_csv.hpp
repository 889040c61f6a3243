// WiFi scans: t_s,bssid,frequency_mhz,rssi_dbm, one row per access point heard, in any order. Rows with equal
// t_s are one scan. BSSIDs are taken in lower case; of one heard twice in a scan the strongest reading stays.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "radioslam/io/text.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// What the receivers of a team heard.
struct WifiRecordings {
  std::vector<std::string> access_points;        ///< BSSIDs over all receivers, lower case, sorted
  std::vector<std::vector<WifiScan>> receivers;  ///< per text, in time order
};

/// What a radio can hear: -150 to 30 dBm.
bool is_plausible_rssi(double rssi_dbm);

/// One text per receiver; one with a header alone has no scans. Refuses an implausible RSSI.
WifiRecordings read_wifi(std::span<const Text> texts);

std::string format_wifi(const std::vector<WifiScan>& scans, const std::vector<std::string>& access_points);

}  // namespace radioslam
