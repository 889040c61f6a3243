// Properties of the rows of every WiFi log.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "fuzzed.hpp"
#include "radioslam/base/check.hpp"
#include "radioslam/io/wifi/wifi_csv.hpp"
#include "radioslam/io/wifi/wifi_log.hpp"
#include "radioslam/io/wifi/wifi_scan_log.hpp"

namespace radioslam {

/// The rows are sorted by time, and the reader of missions accepts them.
inline void check_wifi_log(WifiLog log) {
  std::vector<WifiLog> logs;
  logs.push_back(std::move(log));
  const WifiLog joined = join_wifi_logs(std::move(logs));
  for (std::size_t k = 1; k < joined.rows.size(); ++k)
    RADIOSLAM_CHECK(joined.rows[k - 1].stamp <= joined.rows[k].stamp, "in the order of time");
  try {
    const std::vector<Text> texts{make_text("wifi.csv", format_wifi_rows(joined.rows))};
    read_wifi(texts);
  } catch (const InputError&) {
    RADIOSLAM_CHECK(false, "a mission's reader takes the rows");
  }
}

/// Passes the bytes to the reader of a scan list, and its lists to the conversion to rows.
template <class Reader>
int fuzz_printed_list(const std::uint8_t* data, std::size_t size, Reader&& read) {
  try {
    const Text text = make_tool_output("input", std::string(data, data + size));
    ScanListLog log = read(text);
    time_scans(text, log, std::nullopt);
    for (const bool keep_stale : {false, true}) {
      ScanListParams params;
      params.keep_stale = keep_stale;
      params.clock_offset_s = -4e9;
      check_wifi_log(rows_of_scans({log}, params));
    }
  } catch (const InputError&) {
  }
  return 0;
}

}  // namespace radioslam
