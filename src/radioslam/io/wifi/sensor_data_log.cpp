#include "radioslam/io/wifi/sensor_data_log.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "radioslam/base/statistics.hpp"
#include "radioslam/io/text/line_fields.hpp"
#include "radioslam/io/text/mac_address.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/io/text/skipped_records.hpp"
#include "radioslam/io/wifi/wifi_csv.hpp"
#include "radioslam/io/wifi/wifi_log.hpp"

namespace radioslam {
namespace {

using Fields = std::vector<std::string_view>;

constexpr std::size_t kTypeLetters = 4;
constexpr std::size_t kFirstValue = 3;  ///< behind the type and both times
constexpr double kUnitNormRounding = 1e-3;

/// The fields of a line, without an empty one at its end.
Fields split(std::string_view line) {
  Fields fields;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(';', begin), line.size());
    fields.push_back(trim(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  if (fields.back().empty()) fields.pop_back();
  return fields;
}

/// Whether a line begins with a type, four capitals or digits, and a semicolon.
bool has_type(std::string_view line) {
  if (line.size() <= kTypeLetters || line[kTypeLetters] != ';') return false;
  return std::all_of(line.begin(), line.begin() + kTypeLetters,
                     [](char c) { return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); });
}

/// The delays of a sensor's samples from its clock to the app's.
class SensorClock {
 public:
  void add(Stamp app, Stamp sensor) {
    delays_s_.push_back(seconds_between(sensor, app));
    sensors_.push_back(sensor);
  }

  /// Moves the samples from the app's times to the sensor's, if that one runs.
  template <class Sample>
  void apply(std::vector<Sample>& samples) const {
    if (samples.empty() || sensors_.front() == sensors_.back()) return;
    const Stamp delay = Stamp::from_seconds(upper_median(delays_s_));
    for (std::size_t k = 0; k < samples.size(); ++k) samples[k].stamp = Stamp{sensors_[k].ns + delay.ns};
  }

 private:
  std::vector<double> delays_s_;
  std::vector<Stamp> sensors_;
};

class SensorDataReader {
 public:
  explicit SensorDataReader(const Text& text) : text_(text), at_(text) {}

  PhoneLog read() {
    std::size_t used = 0;
    while (at_.next()) {
      const std::string_view line = trim(at_.line());
      if (line.empty() || line.front() == '%') continue;
      if (skipped_.attempt([&] { read_record(line); })) ++used;
    }
    if (used == 0) skipped_.throw_first();
    force_clock_.apply(log_.motion.specific_force_mps2);
    rate_clock_.apply(log_.motion.angular_rate_radps);
    orientation_clock_.apply(log_.motion.orientation);
    sort_phone_records(log_, text_.name, skipped_);
    skipped_.conclude(text_.name, "record", used, log_.warnings);
    if (const auto note = control_character_note(text_)) log_.warnings.push_back(*note);
    find_interval();
    log_.complete = true;  // the app writes no end
    return std::move(log_);
  }

 private:
  void read_record(std::string_view line) {
    if (!has_type(line)) at_.fail("does not begin with a record's type, four capitals");
    const Fields fields = split(line);
    if (fields[0] == "ACCE") add_vector(fields, log_.motion.specific_force_mps2, force_clock_);
    if (fields[0] == "GYRO") add_vector(fields, log_.motion.angular_rate_radps, rate_clock_);
    if (fields[0] == "AHRS") add_orientation(fields);
    if (fields[0] == "WIFI") log_.wifi.push_back(scan_entry(fields));
  }

  Eigen::Vector3d vector_in(const Fields& fields, std::size_t first) const {
    if (fields.size() < first + 3)
      at_.fail(std::string(fields[0]) + " has " + std::to_string(fields.size()) + " fields" +
               (at_.terminated() ? "" : "; the file ends in this line"));
    return {number_in(at_, fields[first], "x"), number_in(at_, fields[first + 1], "y"),
            number_in(at_, fields[first + 2], "z")};
  }

  Stamp time_in(std::string_view field, const char* what) const {
    const Stamp stamp = stamp_in(at_, field, what);
    if (std::abs(stamp.seconds()) > kLatestTime_s) at_.fail(std::string(what) + " is not a possible time");
    return stamp;
  }

  /// Reads both times of a sample, and adds them to its clock.
  Stamp time_of(const Fields& fields, SensorClock& clock) const {
    const Stamp app = time_in(fields[1], "the app's time");
    const Stamp sensor = time_in(fields[2], "the sensor's time");
    clock.add(app, sensor);
    return app;
  }

  void add_vector(const Fields& fields, std::vector<VectorSample>& samples, SensorClock& clock) const {
    const Eigen::Vector3d value = vector_in(fields, kFirstValue);
    samples.push_back({time_of(fields, clock), value});
  }

  void add_orientation(const Fields& fields) {
    const Eigen::Vector3d v = vector_in(fields, kFirstValue + 3);
    if (v.squaredNorm() > 1 + kUnitNormRounding) at_.fail("the rotation vector is longer than 1");
    const double w = std::sqrt(std::max(0.0, 1 - v.squaredNorm()));
    const Eigen::Quaterniond rotation = Eigen::Quaterniond(w, v.x(), v.y(), v.z()).normalized();
    log_.motion.orientation.push_back({time_of(fields, orientation_clock_), rotation});
  }

  /// Finds the address from the end, because a network's name may contain semicolons.
  ScanEntry scan_entry(const Fields& fields) const {
    std::size_t at = fields.size();
    std::optional<std::string> bssid;
    while (!bssid && at > kFirstValue) bssid = parse_bssid(canonical_bssid(fields[--at]));
    const std::size_t behind = fields.size() - 1 - at;
    if (!bssid || behind < 1 || behind > 2) at_.fail("WIFI has no address before a level");
    ScanEntry entry;
    entry.scan = entry.last_seen = time_in(fields[1], "the app's time");
    entry.bssid = *bssid;
    const double rssi_dbm = number_in(at_, fields.back(), "signal strength");
    if (!is_plausible_rssi(rssi_dbm)) at_.fail("the signal strength is not plausible (-150 to 30 dBm)");
    entry.rssi_dbm = static_cast<float>(rssi_dbm);
    if (behind == 2) entry.frequency_mhz = static_cast<float>(number_in(at_, fields[at + 1], "frequency"));
    return entry;
  }

  /// The interval of the records that are kept.
  void find_interval() {
    bool is_first = true;
    const auto include = [&](const auto& records, const auto& stamp_of) {
      if (records.empty()) return;
      const Stamp begin = stamp_of(records.front()), end = stamp_of(records.back());
      log_.begin = is_first ? begin : std::min(log_.begin, begin);
      log_.end = is_first ? end : std::max(log_.end, end);
      is_first = false;
    };
    const auto by_stamp = [](const auto& sample) { return sample.stamp; };
    include(log_.motion.specific_force_mps2, by_stamp);
    include(log_.motion.angular_rate_radps, by_stamp);
    include(log_.wifi, [](const ScanEntry& entry) { return entry.scan; });
    if (is_first) text_.fail(0, "the log contains no records of motion or WiFi");
    if (log_.end <= log_.begin) text_.fail(0, "all records of the log have the same time");
    log_.start = log_.begin;
  }

  const Text& text_;
  TextLines at_;
  PhoneLog log_;
  SkippedRecords skipped_;
  SensorClock force_clock_, rate_clock_, orientation_clock_;
};

}  // namespace

bool is_sensor_data_log(const Text& text) {
  TextLines lines(text);
  while (lines.next())
    if (const std::string_view line = trim(lines.line()); !line.empty() && line.front() != '%')
      return has_type(line);
  return false;
}

PhoneLog read_sensor_data_log(const Text& text) { return SensorDataReader(text).read(); }

}  // namespace radioslam
