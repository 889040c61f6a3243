#include "radioslam/io/wifi/iw_ftm.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>

#include "radioslam/base/units.hpp"
#include "radioslam/io/text/mac_address.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/io/text/skipped_records.hpp"

namespace radioslam {
namespace {

constexpr std::string_view kHead = "Peer measurements (cookie ";
constexpr std::string_view kPeer = "Peer ";
constexpr double kMetresPerPicosecond = 299'792'458e-12 / 2;  // round trip
constexpr double kMaxYears_s = 9e9;      // the difference of two times must fit 292 years
constexpr double kDisagreement_m = 0.1;  // rounding and driver calibration
constexpr double kDisagreement = 0.1;    // relative to the distance

/// The values in the lines of one peer.
struct PeerResult {
  std::size_t line = 0;
  std::string bssid;
  std::optional<Stamp> measured, printed;
  bool failed = false;
  std::map<std::string, double, std::less<>> values;  ///< by key, such as RTT_AVG

  std::optional<double> value(std::string_view key) const {
    const auto found = values.find(key);
    return found == values.end() ? std::nullopt : std::optional(found->second);
  }
};

bool is_hex(char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); }

bool is_address(std::string_view s) {
  if (s.size() != kMacTextLength) return false;
  for (std::size_t k = 0; k < s.size(); ++k)
    if (k % 3 == 2 ? s[k] != ':' : !is_hex(s[k])) return false;
  return true;
}

bool is_read(std::string_view key) {
  return key == "RTT_AVG" || key == "RTT_VARIANCE" || key == "DIST_AVG" || key == "DIST_VARIANCE";
}

/// Removes the next word from `rest` and returns it.
std::string_view take_word(std::string_view& rest) {
  rest = trim(rest);
  const std::size_t end = std::min(rest.find_first_of(" \t"), rest.size());
  const std::string_view word = rest.substr(0, end);
  rest.remove_prefix(end);
  return word;
}

/// Collects the lines of each peer.
class ResultReader {
 public:
  explicit ResultReader(const Text& text) : at_(text) {}

  /// A refused line costs the result that it belongs to.
  std::vector<PeerResult> read(SkippedRecords& skipped) {
    while (at_.next()) {
      const std::string_view line = trim(at_.line());
      if (skipped.attempt([&] { read_line(line); })) continue;
      results_.pop_back();
      is_inside_ = false;
    }
    return std::move(results_);
  }

 private:
  void read_line(std::string_view line) {
    if (const auto head = line.find(kHead); head != std::string_view::npos)
      start_event(line.substr(0, head));
    else if (line.starts_with(kPeer))
      start_peer(line.substr(kPeer.size()));
    else if (is_inside_)
      read_inside(line);
  }

  /// "1574407123.123456: wlan0 (phy #0): "; other forms of the time are ignored.
  void start_event(std::string_view prefix) {
    is_inside_ = false;
    const std::string_view first = take_word(prefix);
    printed_ = first.ends_with(':') ? parse_stamp(first.substr(0, first.size() - 1)) : std::nullopt;
  }

  /// "02:00:00:00:01:00: status=0 (SUCCESS) @8123456789 tsf=0 (final)", or why there is no result.
  void start_peer(std::string_view line) {
    PeerResult& result = results_.emplace_back();
    is_inside_ = true;
    result.line = at_.number();
    result.printed = printed_;
    std::string_view address = take_word(line);
    if (!address.ends_with(':')) at_.fail("the peer's address is not followed by a colon");
    address.remove_suffix(1);
    result.bssid = lower_case(address);
    if (!is_address(result.bssid)) at_.fail("'" + result.bssid + "' is not a valid address of a peer");
    while (!trim(line).empty()) {
      const std::string_view word = take_word(line);
      if (word.starts_with("status=")) result.failed = result.failed || word != "status=0";
      if (word.starts_with('@')) result.measured = boot_time(word.substr(1));
      if (word == "-" || word == "no" || word == "failed") result.failed = true;
    }
  }

  Stamp boot_time(std::string_view word) const {
    const auto ns = parse_integer(word);
    if (!ns || *ns < 0) at_.fail("'" + std::string(word) + "' is not a time in nanoseconds");
    return {*ns};
  }

  void read_inside(std::string_view line) {
    PeerResult& result = results_.back();
    if (line.starts_with("FTM failed")) result.failed = true;
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos || !is_read(line.substr(0, colon))) return;
    const std::string_view key = line.substr(0, colon);
    const auto number = parse_integer(trim(line.substr(colon + 1)));
    if (!number) at_.fail(std::string(key) + " is not a whole number");
    if (key.ends_with("VARIANCE") && *number < 0) at_.fail(std::string(key) + " is negative");
    if (!result.values.emplace(key, static_cast<double>(*number)).second)
      at_.fail(std::string(key) + " appears twice in one result");
  }

  TextLines at_;
  std::vector<PeerResult> results_;
  std::optional<Stamp> printed_;
  bool is_inside_ = false;
};

/// Host time minus time since boot; nothing if no result has both.
std::optional<std::int64_t> boot_ns(const std::vector<PeerResult>& results) {
  std::optional<std::int64_t> least;
  for (const PeerResult& result : results) {
    if (!result.measured || !result.printed) continue;
    if (std::abs(result.printed->seconds() - result.measured->seconds()) > kMaxYears_s) continue;
    const std::int64_t difference = result.printed->ns - result.measured->ns;
    least = std::min(least.value_or(difference), difference);
  }
  return least;
}

/// The time of a result; nothing if it has none or if it is out of range.
std::optional<Stamp> time_of(const PeerResult& result, std::optional<std::int64_t> boot, double offset_s) {
  if (!result.measured && !result.printed) return std::nullopt;
  const std::int64_t ns = result.measured ? result.measured->ns : result.printed->ns;
  const std::int64_t since = result.measured ? boot.value_or(0) : 0;
  const double on_host_clock_ns = static_cast<double>(ns) + static_cast<double>(since);
  const auto fits = [](double time_ns) { return std::abs(time_ns) < 9e18; };
  if (!fits(on_host_clock_ns) || !fits(on_host_clock_ns + offset_s * kNanosecondsPerSecond))
    return std::nullopt;
  return Stamp{ns + since + std::llround(offset_s * kNanosecondsPerSecond)};
}

/// A distance and its standard deviation, if stated.
struct Distance {
  double range_m = 0;
  std::optional<double> sigma_m;
};

std::optional<Distance> distance(const PeerResult& result, std::string_view mean, std::string_view variance,
                                 double metres_per_unit) {
  const auto value = result.value(mean), squared = result.value(variance);
  if (!value) return std::nullopt;
  Distance distance{*value * metres_per_unit, std::nullopt};
  if (squared && *squared > 0) distance.sigma_m = std::sqrt(*squared) * metres_per_unit;
  return distance;
}

void add(const PeerResult& result, std::optional<Stamp> stamp, const IwFtmParams& params, IwFtmLog& log) {
  const auto by_time = distance(result, "RTT_AVG", "RTT_VARIANCE", kMetresPerPicosecond);
  const auto by_driver = distance(result, "DIST_AVG", "DIST_VARIANCE", kMetresPerMillimetre);
  if (result.failed || (!by_time && !by_driver)) {
    ++log.failed;
    return;
  }
  if (!stamp) {
    ++log.timeless;
    return;
  }
  const Distance& chosen = by_time ? *by_time : *by_driver;
  if (chosen.range_m < -params.max_negative_m || chosen.range_m > params.max_range_m) {
    ++log.implausible;
    return;
  }
  if (by_time && by_driver &&
      std::abs(by_time->range_m - by_driver->range_m) >
          kDisagreement_m + kDisagreement * std::abs(by_time->range_m))
    ++log.disagreeing;
  const double sigma_m =
      chosen.sigma_m ? std::max(*chosen.sigma_m, params.min_sigma_m) : params.nominal_sigma_m;
  log.ranges.push_back({*stamp, result.bssid, std::max(0.0, chosen.range_m), sigma_m});
}

}  // namespace

IwFtmLog read_iw_ftm(const Text& text, const IwFtmParams& params) {
  IwFtmLog log;
  SkippedRecords skipped;
  const std::vector<PeerResult> results = ResultReader(text).read(skipped);
  skipped.conclude(text.name, "result", results.size(), log.warnings);
  if (results.empty()) text.fail(0, "contains no result of iw's peer measurements");
  const auto boot = boot_ns(results);
  for (const PeerResult& result : results)
    add(result, time_of(result, boot, params.clock_offset_s), params, log);
  std::stable_sort(log.ranges.begin(), log.ranges.end(),
                   [](const FtmRange& a, const FtmRange& b) { return a.stamp < b.stamp; });
  return log;
}

}  // namespace radioslam
