#include "radioslam/io/printed_scans.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <set>
#include <utility>

namespace radioslam {
namespace {

constexpr const char* kStale = "are leftovers of an earlier scan and left out";
constexpr const char* kKeptStale = "are leftovers of an earlier scan, kept at the time they were heard";
constexpr const char* kNoLevel = "have no level in dBm and are left out";
constexpr const char* kBootTimes =
    ": its times are seconds since the machine started: neither a line, nor its name, nor the call tells "
    "others";
constexpr const char* kNothing = "scans list nothing";

bool lists_a_radio_twice(const PrintedScan& scan) {
  std::set<std::pair<std::string, double>> seen;
  return std::any_of(scan.readings.begin(), scan.readings.end(), [&](const PrintedReading& reading) {
    return !seen.emplace(reading.bssid, reading.frequency_mhz).second;
  });
}

/// Turns lists in the order of time into rows.
class RowMaker {
 public:
  explicit RowMaker(const PrintedScanParams& params) : params_(params) {}

  void add(const PrintedScan& scan) {
    for (const PrintedReading& reading : scan.readings) add(scan, reading);
    previous_ = scan.stamp;
  }
  WifiLog take() { return std::move(log_); }

 private:
  void add(const PrintedScan& scan, const PrintedReading& reading) {
    if (!reading.rssi_dbm) {
      ++log_.counts[kNoLevel];
      return;
    }
    const bool is_stale =
        previous_ && *previous_ < *scan.stamp && reading.age_s > seconds_between(*previous_, *scan.stamp);
    if (is_stale) ++log_.counts[params_.keep_stale ? kKeptStale : kStale];
    if (is_stale && !params_.keep_stale) return;
    const double offset_s = params_.clock_offset_s - (is_stale ? reading.age_s : 0);
    log_.rows.push_back({on_clock_ahead_by(offset_s, *scan.stamp), reading.bssid,
                         static_cast<float>(reading.frequency_mhz), static_cast<float>(*reading.rssi_dbm)});
  }

  PrintedScanParams params_;
  std::optional<Stamp> previous_;
  WifiLog log_;
};

/// Moves lists dated by the boot clock, as one.
void move_to(PrintedLog& log, const ToldTime& time) {
  const PrintedScan& at = time.of == ToldTime::Of::kFirst ? log.scans.front() : log.scans.back();
  const std::int64_t ahead_ns = time.stamp.ns - at.stamp->ns;
  for (PrintedScan& scan : log.scans) {
    scan.stamp = Stamp{scan.stamp->ns + ahead_ns};
    scan.clock = PrintedClock::kTold;
  }
}

}  // namespace

std::optional<PrintedClock> clock_of(const PrintedLog& log) {
  return log.scans.empty() ? std::nullopt : std::optional(log.scans.front().clock);
}

void time_scans(const Text& text, PrintedLog& log, const std::optional<ToldTime>& time) {
  const std::size_t empty =
      std::erase_if(log.scans, [](const PrintedScan& scan) { return scan.readings.empty(); });
  if (empty > 0) log.counts[kNothing] += empty;
  if (clock_of(log) == PrintedClock::kBoot) {
    if (time)
      move_to(log, *time);
    else
      log.warnings.push_back(text.name + kBootTimes);
  }
  for (PrintedScan& scan : log.scans) {
    if (scan.stamp) continue;
    if (log.scans.size() > 1)
      text.fail(scan.line, "this scan has no time; a line with the Unix time is expected before each");
    scan.stamp = time ? time->stamp : Stamp{0};
    if (lists_a_radio_twice(scan))
      log.warnings.push_back(text.name + ": lists a radio twice; if these are several scans, put a line " +
                             "with the Unix time before each");
  }
}

WifiLog rows_of_scans(std::vector<PrintedLog> logs, const PrintedScanParams& params) {
  std::vector<PrintedScan> scans;
  std::vector<WifiLog> parts(1);
  for (PrintedLog& log : logs) {
    std::move(log.scans.begin(), log.scans.end(), std::back_inserter(scans));
    parts.push_back({{}, std::move(log.counts), std::move(log.warnings)});
  }
  std::stable_sort(scans.begin(), scans.end(),
                   [](const PrintedScan& a, const PrintedScan& b) { return *a.stamp < *b.stamp; });
  RowMaker maker(params);
  for (const PrintedScan& scan : scans) maker.add(scan);
  parts.front() = maker.take();
  return join_wifi_logs(std::move(parts));
}

}  // namespace radioslam
