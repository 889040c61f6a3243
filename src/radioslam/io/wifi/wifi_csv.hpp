// Reads and writes wifi.csv: t_s,bssid,frequency_mhz,rssi_dbm, one row per received access point, in any
// order. Rows with equal t_s form one scan. BSSIDs are written as canonical_bssid does, so that robots may
// spell one address in different ways. If one appears twice in a scan, its strongest reading is kept.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "radioslam/io/text/text.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// BSSIDs of one receiver that it or another one also writes in another way.
struct Respelled {
  std::size_t count = 0;
  std::string example;  ///< as this receiver writes it, not canonical; empty if there is none
};

/// The WiFi scans of all receivers of a team.
struct WifiRecordings {
  std::vector<std::string> access_points;        ///< BSSIDs of all receivers, canonical, sorted
  std::vector<std::vector<WifiScan>> receivers;  ///< per text, in time order
  std::vector<Respelled> respelled;              ///< per text
};

/// Whether a signal strength is plausible: from -150 to 30 dBm.
bool is_plausible_rssi(double rssi_dbm);

/// Reads one text per receiver (read_tool_output: columns that are not read may hold names of networks, which
/// may have any bytes); a text with only a header has no scans. Refuses implausible signal strengths, and
/// BSSIDs that are not plain text.
WifiRecordings read_wifi(std::span<const Text> texts);

std::string format_wifi(const std::vector<WifiScan>& scans, const std::vector<std::string>& access_points);

}  // namespace radioslam
