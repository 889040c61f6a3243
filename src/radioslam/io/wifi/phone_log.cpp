#include "radioslam/io/wifi/phone_log.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>

#include "radioslam/base/units.hpp"
#include "radioslam/io/text/line_fields.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/io/text/skipped_records.hpp"
#include "radioslam/io/wifi/log_time.hpp"

namespace radioslam {
namespace {

constexpr std::int64_t kMaxTime_ms = 9'000'000'000'000;  // the year 2255, which fits in nanoseconds
constexpr std::string_view kTypePrefix = "TYPE_";
constexpr std::string_view kStartTime = "startTime:";
constexpr std::string_view kEndTime = "endTime:";
constexpr std::size_t kMotionFields = 6;
constexpr std::size_t kWaypointFields = 4;
constexpr std::size_t kWifiFields = 7;  // more if the network's name contains tabs
constexpr std::string_view kBssidBytes = "0123456789abcdefghijklmnopqrstuvwxyz:-_.";
constexpr double kUnitNormRounding = 1e-3;
constexpr double kWeakestRssi_dbm = -150;
constexpr double kStrongestRssi_dbm = 30;

using Fields = std::vector<std::string_view>;

Fields split_at_tabs(std::string_view line) {
  Fields fields;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find('\t', begin), line.size());
    fields.push_back(trim(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  return fields;
}

Stamp milliseconds_in(const TextLines& at, std::string_view field, const std::string& what) {
  const auto ms = parse_integer(field);
  if (ms && *ms >= 0 && *ms <= kMaxTime_ms) return {*ms * kNanosecondsPerMillisecond};
  const auto other =
      parse_time_line(field);  // of other apps: micro- and nanoseconds, seconds with a fraction
  if (!other) at.fail(what + " is not a time in whole milliseconds");
  return *other;
}

/// Reads one log.
class PhoneLogReader {
 public:
  explicit PhoneLogReader(const Text& text) : text_(text), at_(text) {}

  PhoneLog read() {
    std::size_t used = 0;
    while (at_.next()) {
      const std::string_view line = trim(at_.line());
      if (line.empty()) continue;
      if (skipped_.attempt([&] { read_line(line); })) ++used;
    }
    find_interval();
    sort_phone_records(log_, text_.name, skipped_);
    skipped_.conclude(text_.name, "record", used, log_.warnings);
    if (const auto note = control_character_note(text_)) log_.warnings.push_back(*note);
    if (!first_) text_.fail(0, "the log contains no records");
    log_.start = start_time_.value_or(*first_);
    log_.begin = std::min(log_.start, *first_);
    if (log_.end <= log_.begin) text_.fail(0, "all records of the log have the same time");
    if (log_.motion.specific_force_mps2.empty()) text_.fail(0, "the log has no TYPE_ACCELEROMETER records");
    if (log_.motion.angular_rate_radps.empty()) text_.fail(0, "the log has no TYPE_GYROSCOPE records");
    return std::move(log_);
  }

 private:
  void read_line(std::string_view line) {
    if (line.front() == '#')
      read_comment(line.substr(1));
    else
      read_record(split_at_tabs(line));
  }

  /// The first and the last time of all records that are in order within their kind.
  void find_interval() {
    for (const auto& [type, stamps] : stamps_) {
      const SortedRows rows = sort_rows_by_time(stamps);
      const Stamp begin = stamps[rows.kept.front()], end = stamps[rows.kept.back()];
      log_.end = first_ ? std::max(log_.end, end) : end;
      first_ = first_ ? std::min(*first_, begin) : begin;
    }
  }

  void read_comment(std::string_view comment) {
    for (const std::string_view field : split_at_tabs(comment)) {
      if (field.starts_with(kStartTime))
        start_time_ = milliseconds_in(at_, field.substr(kStartTime.size()), "the start time");
      if (field.starts_with(kEndTime)) log_.complete = true;
    }
  }

  void read_record(const Fields& fields) {
    const Stamp stamp = milliseconds_in(at_, fields[0], "the first field");
    if (fields.size() < 2 || !fields[1].starts_with(kTypePrefix))
      at_.fail("the second field is not a record type (TYPE_...)");
    const std::string_view type = fields[1].substr(kTypePrefix.size());
    const bool is_wifi = type == "WIFI";
    for (std::size_t i = is_wifi ? 3 : 2; i < fields.size(); ++i)
      if (fields[i].starts_with(kTypePrefix)) at_.fail("two lines without a line break between them");

    if (type == "ACCELEROMETER")
      log_.motion.specific_force_mps2.push_back(VectorSample{stamp, vector_of(fields)});
    if (type == "GYROSCOPE") log_.motion.angular_rate_radps.push_back(VectorSample{stamp, vector_of(fields)});
    if (type == "ROTATION_VECTOR") log_.motion.orientation.push_back(orientation_sample(stamp, fields));
    if (type == "WAYPOINT") log_.waypoints.push_back(waypoint(stamp, fields));
    if (is_wifi) log_.wifi.push_back(scan_entry(stamp, fields));
    stamps_[std::string(type)].push_back(stamp);
  }

  void expect_fields(const Fields& fields, std::size_t count) const {
    if (fields.size() == count) return;
    const std::string torn = at_.terminated() ? "" : "; the file ends in this line";
    at_.fail(std::string(fields[1]) + " has " + std::to_string(fields.size()) + " fields instead of " +
             std::to_string(count) + torn);
  }

  Eigen::Vector3d vector_of(const Fields& fields) const {
    expect_fields(fields, kMotionFields);
    return {number_in(at_, fields[2], "x"), number_in(at_, fields[3], "y"), number_in(at_, fields[4], "z")};
  }

  OrientationSample orientation_sample(Stamp stamp, const Fields& fields) const {
    const Eigen::Vector3d v = vector_of(fields);
    const double square = v.squaredNorm();
    if (square > 1 + kUnitNormRounding) at_.fail("the rotation vector is longer than 1");
    const double w = std::sqrt(std::max(0.0, 1 - square));
    return {stamp, Eigen::Quaterniond(w, v.x(), v.y(), v.z()).normalized()};
  }

  Waypoint waypoint(Stamp stamp, const Fields& fields) const {
    expect_fields(fields, kWaypointFields);
    return {stamp, {coordinate_in(at_, fields[2], "x"), coordinate_in(at_, fields[3], "y")}};
  }

  /// Reads from the last field backwards, because a network's name may contain tabs.
  ScanEntry scan_entry(Stamp stamp, const Fields& fields) const {
    if (fields.size() < kWifiFields) expect_fields(fields, kWifiFields);
    const auto from_end = [&fields](std::size_t i) { return fields[fields.size() - i]; };
    ScanEntry entry;
    entry.scan = stamp;
    entry.last_seen = milliseconds_in(at_, from_end(1), "the last-seen time");
    entry.frequency_mhz = static_cast<float>(number_in(at_, from_end(2), "frequency"));
    const double rssi_dbm = number_in(at_, from_end(3), "signal strength");
    if (rssi_dbm < kWeakestRssi_dbm || rssi_dbm > kStrongestRssi_dbm)
      at_.fail("the signal strength is not plausible (-150 to 30 dBm)");
    entry.rssi_dbm = static_cast<float>(rssi_dbm);
    entry.bssid = lower_case(from_end(4));
    if (entry.bssid.empty() || entry.bssid.find_first_not_of(kBssidBytes) != std::string::npos)
      at_.fail("the access point has no BSSID that can be written to a table");
    return entry;
  }

  const Text& text_;
  TextLines at_;
  PhoneLog log_;
  SkippedRecords skipped_;
  std::map<std::string, std::vector<Stamp>> stamps_;  ///< of all records, by kind
  std::optional<Stamp> first_, start_time_;
};

}  // namespace

void sort_phone_records(PhoneLog& log, const std::string& name, SkippedRecords& skipped) {
  const auto by_stamp = [](const auto& record) { return record.stamp; };
  std::size_t moved = 0;
  const auto sort = [&](auto& records, const auto& stamp_of, const char* kind) {
    const auto refusal = [&, before = records](std::size_t row) {
      return InputError(name, 0,
                        std::string(kind) + " at " + format_stamp(stamp_of(before[row])) +
                            " s: time runs backwards by more than a second",
                        InputError::Kind::kClock);
    };
    moved += sort_records(records, stamp_of, refusal, skipped);
  };
  sort(log.motion.specific_force_mps2, by_stamp, "accelerometer");
  sort(log.motion.angular_rate_radps, by_stamp, "gyroscope");
  sort(log.motion.orientation, by_stamp, "orientation");
  sort(log.waypoints, by_stamp, "waypoint");
  sort(
      log.wifi, [](const ScanEntry& entry) { return entry.scan; }, "WiFi scan");
  const auto same = [](const Waypoint& a, const Waypoint& b) { return a.stamp == b.stamp; };
  log.waypoints.erase(std::unique(log.waypoints.begin(), log.waypoints.end(), same), log.waypoints.end());
  if (moved > 0)
    log.warnings.push_back(name + ": " + std::to_string(moved) +
                           " records are earlier than the one before them and were sorted");
}

bool is_phone_log(const Text& text) {
  TextLines lines(text);
  while (lines.next())
    if (const std::string_view line = trim(lines.line()); !line.empty() && line.front() != '#') {
      const Fields fields = split_at_tabs(line);
      return fields.size() > 1 && fields[1].starts_with(kTypePrefix);
    }
  return false;
}

PhoneLog read_phone_log(const Text& text) { return PhoneLogReader(text).read(); }

}  // namespace radioslam
