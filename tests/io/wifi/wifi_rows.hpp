// Rows of a WiFi log as text, for comparison.
#pragma once

#include <string>
#include <vector>

#include "radioslam/io/wifi/wifi_log.hpp"
#include "radioslam/io/wifi/wifi_scan_log.hpp"

namespace radioslam {

/// "t_s,bssid,frequency_mhz,rssi_dbm" of each row.
inline std::vector<std::string> row_texts(const WifiLog& log) {
  std::vector<std::string> rows;
  for (const WifiRow& row : log.rows) {
    const std::string table = format_wifi_rows({row});
    const std::size_t begin = table.find('\n') + 1;
    rows.push_back(table.substr(begin, table.size() - 1 - begin));
  }
  return rows;
}

/// The rows of one log of scan lists.
inline WifiLog rows_of_list(const Text& text, ScanListLog log, const ScanListParams& params = {}) {
  time_scans(text, log, std::nullopt);
  std::vector<ScanListLog> logs;
  logs.push_back(std::move(log));
  return rows_of_scans(std::move(logs), params);
}

/// An SSID with every byte value, which readers must skip.
inline std::string every_byte() {
  std::string bytes;
  for (int c = 0; c < 256; ++c) bytes += static_cast<char>(c);
  return bytes;
}

using Rows = std::vector<std::string>;

}  // namespace radioslam
