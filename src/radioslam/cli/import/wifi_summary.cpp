#include "radioslam/cli/import/wifi_summary.hpp"

#include <iostream>
#include <set>

namespace radioslam::cli {

void print_notes(const WifiLog& log) {
  for (const std::string& warning : log.warnings) std::cout << "note: " << warning << '\n';
  for (const auto& [what, count] : log.counts) std::cout << "note: " << count << ' ' << what << '\n';
}

std::string wifi_summary(const std::vector<WifiRow>& rows) {
  std::set<std::string> radios;
  std::set<Stamp> scans;
  for (const WifiRow& row : rows) {
    radios.insert(row.bssid);
    scans.insert(row.stamp);
  }
  return std::to_string(rows.size()) + " rows, " + std::to_string(scans.size()) + " scans, " +
         std::to_string(radios.size()) + " radios";
}

}  // namespace radioslam::cli
