// What WiFi tools heard, row by row, on its way into a robot's wifi.csv (wifi_csv.hpp).
//
// The rows are those of the tool: nothing is averaged, and a radio listed twice has two rows. Names of
// networks (SSIDs) are passed over; they may hold any bytes.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/base/stamp.hpp"

namespace radioslam {

/// One radio heard once.
struct WifiRow {
  Stamp stamp;
  std::string bssid;        ///< lower case
  float frequency_mhz = 0;  ///< 0 where it is not known
  float rssi_dbm = 0;
};

struct WifiLog {
  std::vector<WifiRow> rows;
  std::map<std::string, std::size_t> counts;  ///< what was left out or doubtful, in words, and how often
  std::vector<std::string> warnings;          ///< what a user should know besides, one line each
};

/// All rows in the order of time, then as given, without those whose RSSI no mission can hold.
WifiLog join_wifi_logs(std::vector<WifiLog> logs);

/// A wifi.csv with exactly these rows.
std::string format_wifi_rows(const std::vector<WifiRow>& rows);

/// Six bytes joined by ':', in lower case; digits may be 'x', as in logs made anonymous. Nothing otherwise.
std::optional<std::string> parse_bssid(std::string_view text);

/// Later times (seconds) are implausible; so far an offset of the clock fits.
inline constexpr double kLatestTime_s = 4.4e9;

/// `stamp`, at most kLatestTime_s from zero, on a clock that is ahead by `offset_s`, at most as much.
Stamp on_clock_ahead_by(double offset_s, Stamp stamp);

/// "'...'" for messages: cut short, and every byte that is no ASCII character as '?'.
std::string shown_bytes(std::string_view bytes);

}  // namespace radioslam
