#include "radioslam/io/wifi/iw_scan.hpp"

#include <cmath>
#include <utility>

#include "radioslam/base/units.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/io/text/skipped_records.hpp"

namespace radioslam {
namespace {

constexpr std::string_view kBss = "BSS ", kFrequencyMark = "freq:", kSignalMark = "signal:",
                           kLastSeen = "last seen:", kAgo = " ms ago", kBoot = "s [boottime]", kDbm = " dBm";
constexpr double kOldest_s = 1e8;     // three years; plausible upper limit
constexpr double kSamePrint_s = 0.5;  // a list is printed within this time; a scan takes longer

/// Hundredths as iw prints them: "-53.00", "-53.-50", "0.-50", "-53.05".
std::optional<double> parse_hundredths(std::string_view token) {
  const std::size_t point = token.find('.');
  if (point == std::string_view::npos) return parse_number(token);
  std::string_view whole = token.substr(0, point), fraction = token.substr(point + 1);
  const bool is_negative = whole.starts_with('-') || fraction.starts_with('-');
  if (whole.starts_with('-')) whole.remove_prefix(1);
  if (fraction.starts_with('-')) fraction.remove_prefix(1);
  const auto is_plain = [](std::string_view s) {
    return !s.empty() && s.find_first_not_of("0123456789") == std::string_view::npos;
  };
  if (!is_plain(whole) || !is_plain(fraction)) return std::nullopt;
  const auto value = parse_number(std::string(whole) + "." + std::string(fraction));
  return value ? std::optional(is_negative ? -*value : *value) : std::nullopt;
}

/// Collects the lines of each BSS.
class IwScanReader {
 public:
  explicit IwScanReader(const Text& text) : lines_(text) {}

  ScanListLog read(const std::string& name) {
    while (lines_.next()) {
      const std::string_view line = lines_.line();
      if (auto list = list_at_time(lines_, log_, foreign_)) {
        log_.scans.push_back(std::move(*list));
        is_inside_ = false;
      } else if (line.starts_with(kBss)) {
        is_inside_ = false;
        attempt([&] { return start_bss(line.substr(kBss.size())); });
      } else if (!is_inside_ || !attempt([&] { return read_attribute(trim(line)); })) {
        if (!is_indented(line)) foreign_.add(lines_);
      }
    }
    skipped_.conclude(name, "radio", log_.readings(), log_.warnings);
    foreign_.conclude(name, log_);
    return std::move(log_);
  }

 private:
  ScanListReading& reading() { return log_.scans.back().readings.back(); }
  bool is_torn() const { return !lines_.terminated(); }
  static bool is_indented(std::string_view line) { return line.starts_with(' ') || line.starts_with('\t'); }

  /// A refused line costs the radio that it belongs to. False if it was neither read nor refused.
  template <class Read>
  bool attempt(Read&& read) {
    bool is_read = true;
    if (skipped_.attempt([&] { is_read = read(); })) return is_read;
    if (is_inside_) log_.scans.back().readings.pop_back();
    is_inside_ = false;
    return true;
  }

  /// "02:00:00:00:01:00(on wlan0) -- associated"
  bool start_bss(std::string_view rest) {
    has_signal_ = has_frequency_ = false;
    const std::string_view address = rest.substr(0, rest.find_first_of(" (\t"));
    const auto bssid = parse_bssid(address);
    if (!bssid && is_torn()) return true;
    if (!bssid) lines_.fail(quoted_bytes(address) + " is not a valid address of a BSS");
    if (log_.scans.empty()) log_.scans.push_back({lines_.number(), std::nullopt, {}, {}});
    log_.scans.back().readings.emplace_back().bssid = *bssid;
    return is_inside_ = true;
  }

  /// False for lines that are not used.
  bool read_attribute(std::string_view line) {
    if (line.starts_with(kFrequencyMark))
      read_frequency(trim(line.substr(kFrequencyMark.size())));
    else if (line.starts_with(kSignalMark))
      read_signal(trim(line.substr(kSignalMark.size())));
    else if (line.starts_with(kLastSeen))
      read_last_seen(trim(line.substr(kLastSeen.size())));
    else
      return false;
    return true;
  }

  void read_frequency(std::string_view token) {
    if (std::exchange(has_frequency_, true)) lines_.fail("a second frequency for the same BSS");
    const auto mhz = parse_number(token);
    if (mhz && *mhz > 0 && *mhz < kHighest_mhz)
      reading().frequency_mhz = *mhz;
    else if (!is_torn())
      lines_.fail(quoted_bytes(token) + " is not a valid frequency in MHz");
  }

  void read_signal(std::string_view value) {
    if (std::exchange(has_signal_, true)) lines_.fail("a second signal for the same BSS");
    const bool is_dbm = value.ends_with(kDbm);
    const bool is_relative = value.find('/') != std::string_view::npos;
    if (is_dbm) reading().rssi_dbm = parse_hundredths(value.substr(0, value.size() - kDbm.size()));
    if (!reading().rssi_dbm && !is_relative && !is_torn())
      lines_.fail(quoted_bytes(value) + " is not a valid signal in dBm");
  }

  void read_last_seen(std::string_view value) {
    const bool is_boot = value.ends_with(kBoot);
    if (!is_boot && !value.ends_with(kAgo)) {
      if (!is_torn()) lines_.fail(quoted_bytes(value) + " is not a valid 'last seen' time");
      return;
    }
    const std::string_view token = value.substr(0, value.size() - (is_boot ? kBoot : kAgo).size());
    const auto number = parse_number(token);
    const double seconds = number ? *number * (is_boot ? 1 : kSecondsPerMillisecond) : -1;
    if (seconds < 0 || seconds > kOldest_s)
      lines_.fail(quoted_bytes(value) + " is not a valid 'last seen' time");
    if (is_boot)
      reading().heard = parse_stamp(token);
    else
      reading().age_s = seconds;
  }

  static constexpr double kHighest_mhz = 1e6;

  TextLines lines_;
  ScanListLog log_;
  SkippedRecords skipped_;
  ForeignLines foreign_;
  bool is_inside_ = false, has_signal_ = false, has_frequency_ = false;
};

/// The time at which a list was printed, on the boot clock, derived from one of its readings.
std::optional<double> printed_s(const ScanListReading& reading) {
  if (!reading.heard) return std::nullopt;
  return reading.heard->seconds() + reading.age_s;
}

/// Splits a list without a time where its readings show a later printing time, and assigns times to the
/// parts.
std::vector<ScanList> dated_by_boot_clock(ScanList scan) {
  std::vector<ScanList> parts;
  for (ScanListReading& reading : scan.readings) {
    const auto printed = printed_s(reading);
    const bool is_later = printed && !parts.empty() && parts.back().stamp &&
                          std::abs(*printed - parts.back().stamp->seconds()) > kSamePrint_s;
    if (parts.empty() || is_later) parts.push_back({scan.line, std::nullopt, {}, {}});
    if (printed && !parts.back().stamp) {
      parts.back().stamp = Stamp::from_seconds(*printed);
      parts.back().clock = ScanListClock::kBoot;
    }
    parts.back().readings.push_back(std::move(reading));
  }
  return parts;
}

}  // namespace

ScanListLog read_iw_scans(const Text& text) {
  ScanListLog log = IwScanReader(text).read(text.name);
  if (log.readings() == 0) text.fail(0, "contains no BSS of an iw scan");
  // There is a single list only if the log has no time lines.
  if (log.scans.size() == 1 && !log.scans.front().stamp && log.scans.front().unread_time.empty())
    log.scans = dated_by_boot_clock(std::move(log.scans.front()));
  return log;
}

}  // namespace radioslam
