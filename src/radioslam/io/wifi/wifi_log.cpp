#include "radioslam/io/wifi/wifi_log.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "radioslam/base/check.hpp"
#include "radioslam/io/text/mac_address.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/io/text/text.hpp"
#include "radioslam/io/wifi/wifi_csv.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kShownBytes = 40;

bool is_digit_of_bssid(char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') || c == 'x'; }

void append_log(WifiLog& all, WifiLog&& log) {
  std::move(log.rows.begin(), log.rows.end(), std::back_inserter(all.rows));
  std::move(log.warnings.begin(), log.warnings.end(), std::back_inserter(all.warnings));
  for (const auto& [what, count] : log.counts) all.counts[what] += count;
}

}  // namespace

WifiLog join_wifi_logs(std::vector<WifiLog> logs) {
  WifiLog all;
  for (WifiLog& log : logs) append_log(all, std::move(log));
  const std::size_t implausible = std::erase_if(
      all.rows, [](const WifiRow& row) { return !is_plausible_rssi(static_cast<double>(row.rssi_dbm)); });
  if (implausible > 0) all.counts["levels are outside -150 to 30 dBm and left out"] += implausible;
  std::stable_sort(all.rows.begin(), all.rows.end(),
                   [](const WifiRow& a, const WifiRow& b) { return a.stamp < b.stamp; });
  return all;
}

std::string format_wifi_rows(const std::vector<WifiRow>& rows) {
  std::string out = "t_s,bssid,frequency_mhz,rssi_dbm\n";
  for (const WifiRow& row : rows) {
    ((out += format_stamp(row.stamp)) += ',') += row.bssid;
    append_number(out += ',', row.frequency_mhz);
    append_number(out += ',', row.rssi_dbm);
    out += '\n';
  }
  return out;
}

std::optional<std::string> parse_bssid(std::string_view text) {
  if (text.size() != kMacTextLength) return std::nullopt;
  std::string bssid = lower_case(text);
  for (std::size_t k = 0; k < bssid.size(); ++k)
    if (k % 3 == 2 ? bssid[k] != ':' : !is_digit_of_bssid(bssid[k])) return std::nullopt;
  return bssid;
}

Stamp on_clock_ahead_by(double offset_s, Stamp stamp) {
  RADIOSLAM_CHECK(std::abs(stamp.seconds()) <= kLatestTime_s && std::abs(offset_s) <= kLatestTime_s,
                  "the sum of two times fits");
  return {stamp.ns + Stamp::from_seconds(offset_s).ns};
}

std::string quoted_bytes(std::string_view bytes) {
  std::string shown(bytes.substr(0, kShownBytes));
  for (char& c : shown)
    if (c < 0x20 || c > 0x7e) c = '?';
  return "'" + shown + (bytes.size() > kShownBytes ? "...'" : "'");
}

}  // namespace radioslam
