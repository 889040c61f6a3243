// Rows of WiFi readings as imported from tools, before they are written to a robot's wifi.csv (wifi_csv.hpp).
//
// The rows are those of the tool: nothing is averaged, and a radio listed twice has two rows. Network names
// (SSIDs), which may contain any bytes, are skipped.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/base/stamp.hpp"

namespace radioslam {

/// One reading of one radio.
struct WifiRow {
  Stamp stamp;
  std::string bssid;        ///< lower case
  float frequency_mhz = 0;  ///< 0 if unknown
  float rssi_dbm = 0;
};

struct WifiLog {
  std::vector<WifiRow> rows;
  std::map<std::string, std::size_t> counts;  ///< what was left out or is doubtful, with its number
  std::vector<std::string> warnings;          ///< further notes for the user, one line each
};

/// Joins all rows, sorted by time and otherwise in the given order; rows with an implausible RSSI are left
/// out.
WifiLog join_wifi_logs(std::vector<WifiLog> logs);

/// The text of a wifi.csv with exactly these rows.
std::string format_wifi_rows(const std::vector<WifiRow>& rows);

/// Parses six bytes separated by ':' and returns them in lower case; digits may be 'x', as in anonymised
/// logs.
std::optional<std::string> parse_bssid(std::string_view text);

/// Largest plausible time in seconds, and largest magnitude of a clock offset.
inline constexpr double kLatestTime_s = 4.4e9;

/// Converts `stamp` to a clock that is ahead by `offset_s`. Both must be at most kLatestTime_s in magnitude.
Stamp on_clock_ahead_by(double offset_s, Stamp stamp);

/// The bytes in quotes, for messages: shortened, with '?' for every byte that is not a printable ASCII
/// character.
std::string quoted_bytes(std::string_view bytes);

}  // namespace radioslam
