// What imports of WiFi scans print.
#pragma once

#include <string>

#include "radioslam/io/wifi/wifi_log.hpp"

namespace radioslam::cli {

/// Prints what was left out or is doubtful, a line each.
void print_notes(const WifiLog& log);

/// "12 rows, 3 scans, 5 radios".
std::string wifi_summary(const std::vector<WifiRow>& rows);

}  // namespace radioslam::cli
