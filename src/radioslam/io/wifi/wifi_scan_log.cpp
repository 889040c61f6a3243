#include "radioslam/io/wifi/wifi_scan_log.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <set>
#include <utility>

#include "radioslam/io/text/skipped_records.hpp"
#include "radioslam/io/wifi/log_time.hpp"

namespace radioslam {
namespace {

constexpr const char* kStale = "readings are stale (from an earlier scan) and left out";
constexpr const char* kKeptStale =
    "readings are stale (from an earlier scan) and kept at the time they were received";
constexpr const char* kNoLevel = "readings have no level in dBm and are left out";
constexpr const char* kBootTimes =
    ": its times are seconds since boot, because neither a line, nor its name, nor the command line gives "
    "others";
constexpr const char* kNoZone =
    "times have no known time zone and are taken as UTC; --set clock_offset_s=SECONDS corrects them";
constexpr const char* kOnlySeconds =
    "times are followed by what is not understood; their whole seconds are used";
constexpr const char* kNothing = "scans are empty";

bool lists_a_radio_twice(const ScanList& scan) {
  std::set<std::pair<std::string, double>> seen;
  return std::any_of(scan.readings.begin(), scan.readings.end(), [&](const ScanListReading& reading) {
    return !seen.emplace(reading.bssid, reading.frequency_mhz).second;
  });
}

/// Converts lists, in the order of time, to rows.
class RowMaker {
 public:
  explicit RowMaker(const ScanListParams& params) : params_(params) {}

  void add(const ScanList& scan) {
    for (const ScanListReading& reading : scan.readings) add(scan, reading);
    previous_ = scan.stamp;
  }
  WifiLog take() { return std::move(log_); }

 private:
  void add(const ScanList& scan, const ScanListReading& reading) {
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

  ScanListParams params_;
  std::optional<Stamp> previous_;
  WifiLog log_;
};

/// Shifts all lists with boot times by the same offset.
void move_to(ScanListLog& log, const GivenTime& time) {
  const ScanList& at = time.of == GivenTime::Of::kFirst ? log.scans.front() : log.scans.back();
  const std::int64_t ahead_ns = time.stamp.ns - at.stamp->ns;
  for (ScanList& scan : log.scans) {
    scan.stamp = Stamp{scan.stamp->ns + ahead_ns};
    scan.clock = ScanListClock::kExplicit;
  }
}

/// Why a list has no time.
InputError without_time(const Text& text, const ScanList& scan) {
  if (scan.unread_time.empty())
    return {text.name, scan.line,
            "this scan has no time; a line with the Unix time is needed before each scan"};
  return {
      text.name, scan.line,
      scan.unread_time + " is not understood as a time, so that its scan has none; `date +%s` prints one"};
}

void leave_out_undated(const Text& text, ScanListLog& log) {
  SkippedRecords undated;
  for (const ScanList& scan : log.scans)
    if (!scan.stamp) undated.add(without_time(text, scan));
  std::erase_if(log.scans, [](const ScanList& scan) { return !scan.stamp; });
  undated.conclude(text.name, "scan", log.scans.size(), log.warnings);
}

/// A log of one list needs no line with its time.
void time_only_list(const Text& text, ScanListLog& log, const std::optional<GivenTime>& time) {
  ScanList& scan = log.scans.front();
  if (!scan.unread_time.empty() && !time) throw InputError(without_time(text, scan));
  scan.stamp = time ? time->stamp : Stamp{0};
  if (lists_a_radio_twice(scan))
    log.warnings.push_back(text.name + ": lists a radio twice; if these are several scans, put a line " +
                           "with the Unix time before each");
}

}  // namespace

std::size_t ScanListLog::readings() const {
  std::size_t count = 0;
  for (const ScanList& scan : scans) count += scan.readings.size();
  return count;
}

std::optional<ScanList> list_at_time(const TextLines& at, ScanListLog& log, ForeignLines& foreign) {
  const auto time = read_printed_time(at.line());
  if (!time) return std::nullopt;
  if (!time->zone_known) ++log.counts[kNoZone];
  if (time->stamp && !time->is_whole) {
    ++log.counts[kOnlySeconds];
    foreign.add(at);
  }
  ScanList list{at.number(), time->stamp, {}, {}};
  if (!time->stamp) list.unread_time = quoted_bytes(at.line());
  return list;
}

void ForeignLines::add(const TextLines& at) {
  if (trim(at.line()).empty() || ++count_ > 1) return;
  first_ = at.number();
  shown_ = quoted_bytes(at.line());
}

void ForeignLines::conclude(const std::string& name, ScanListLog& log) const {
  if (count_ == 0) return;
  log.warnings.push_back(name + ":" + std::to_string(first_) + ": " + shown_ + " is not understood" +
                         (count_ == 1 ? "" : ", nor are " + std::to_string(count_ - 1) + " other lines"));
}

std::optional<ScanListClock> clock_of(const ScanListLog& log) {
  return log.scans.empty() ? std::nullopt : std::optional(log.scans.front().clock);
}

void time_scans(const Text& text, ScanListLog& log, const std::optional<GivenTime>& time) {
  const std::size_t empty =
      std::erase_if(log.scans, [](const ScanList& scan) { return scan.readings.empty(); });
  if (empty > 0) log.counts[kNothing] += empty;
  if (clock_of(log) == ScanListClock::kBoot) {
    if (time)
      move_to(log, *time);
    else
      log.warnings.push_back(text.name + kBootTimes);
  }
  if (log.scans.size() == 1 && !log.scans.front().stamp)
    time_only_list(text, log, time);
  else
    leave_out_undated(text, log);
}

WifiLog rows_of_scans(std::vector<ScanListLog> logs, const ScanListParams& params) {
  std::vector<ScanList> scans;
  std::vector<WifiLog> parts(1);
  for (ScanListLog& log : logs) {
    std::move(log.scans.begin(), log.scans.end(), std::back_inserter(scans));
    parts.push_back({{}, std::move(log.counts), std::move(log.warnings)});
  }
  std::stable_sort(scans.begin(), scans.end(),
                   [](const ScanList& a, const ScanList& b) { return *a.stamp < *b.stamp; });
  RowMaker maker(params);
  for (const ScanList& scan : scans) maker.add(scan);
  parts.front() = maker.take();
  return join_wifi_logs(std::move(parts));
}

}  // namespace radioslam
