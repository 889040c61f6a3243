#include "radioslam/io/lidar/point_times.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "radioslam/base/check.hpp"
#include "radioslam/base/statistics.hpp"

namespace radioslam {
namespace {

constexpr double kMaxOffset_s = 1e6;               ///< larger times are absolute
constexpr double kSmallestNanoseconds = 1e12;      ///< in seconds this would be 30,000 years after the epoch
constexpr double kMaxSweep = 2, kMinSweep = 0.01;  ///< relative to the interval between scans
constexpr double kMaxShortSweep_s = 1,
                 kFarthestSweep_s = 1;  ///< longest sweep for which a different clock can be detected
constexpr double kCoarsest_s = 1e-3;
constexpr double kConstantGrains = 4;
constexpr std::size_t kMinScansToFreeze = 3;
constexpr double kFrozenShare = 0.1;  ///< of the time between the scans
constexpr std::array kUnits{PointTimeUnit::kSecond, PointTimeUnit::kMillisecond, PointTimeUnit::kMicrosecond,
                            PointTimeUnit::kNanosecond};

double seconds_of(PointTimeUnit unit) {
  switch (unit) {
    case PointTimeUnit::kSecond:
      return 1;
    case PointTimeUnit::kMillisecond:
      return 1e-3;
    case PointTimeUnit::kMicrosecond:
      return 1e-6;
    default:
      return 1e-9;
  }
}

/// A time as an exact integer if the column holds integers, otherwise as floating point.
struct RawTime {
  double floating = 0;
  std::int64_t whole = 0;
};

/// The column of times.
class TimeColumn {
 public:
  TimeColumn(const PointTable& table, const PointColumn& column)
      : table_(table), column_(column), is_whole_(!is_floating(column.type)) {}

  RawTime at(std::size_t row) const {
    if (!is_whole_) return {floating_at(table_, column_, row), 0};
    const std::int64_t whole = whole_at(table_, column_, row);
    return {static_cast<double>(whole), whole};
  }

  /// a - b, computed exactly for integers unless it overflows.
  double difference(const RawTime& a, const RawTime& b) const {
    std::int64_t exact = 0;
    if (is_whole_ && !__builtin_sub_overflow(a.whole, b.whole, &exact)) return static_cast<double>(exact);
    return a.floating - b.floating;
  }

  PointTimeUnit nominal_unit(const RawTime& time) const {
    return is_whole_ || time.floating >= kSmallestNanoseconds ? PointTimeUnit::kNanosecond
                                                              : PointTimeUnit::kSecond;
  }

  /// The stamp in the unit of these times; exact only for nanoseconds.
  RawTime of_stamp(Stamp stamp, PointTimeUnit unit) const {
    if (unit == PointTimeUnit::kNanosecond) return {static_cast<double>(stamp.ns), stamp.ns};
    const double time = stamp.seconds() / seconds_of(unit);
    return {time, is_whole_ ? static_cast<std::int64_t>(std::llround(time)) : 0};
  }

  /// Resolution of times of this magnitude; 0 for integers.
  double grain(const RawTime& time) const {
    if (is_whole_) return 0;
    return std::abs(time.floating) * (column_.type == NumberType::kFloat32
                                          ? static_cast<double>(std::numeric_limits<float>::epsilon())
                                          : std::numeric_limits<double>::epsilon());
  }

 private:
  const PointTable& table_;
  const PointColumn& column_;
  bool is_whole_;
};

struct FirstAndLast {
  RawTime first, last;
  std::size_t points = 0;
};

/// Whether all times are one constant, but for rounding.
bool are_constant(const TimeColumn& times, const FirstAndLast& ends) {
  return ends.points > 1 &&
         times.difference(ends.last, ends.first) <= kConstantGrains * times.grain(ends.last);
}

bool is_somewhere(const Eigen::Vector3f& point) { return point.allFinite() && !point.isZero(0); }

/// First and last time of points with finite, non-zero coordinates; without any, of all points with a time.
std::optional<FirstAndLast> first_and_last(const PointTable& table, const TimeColumn& times) {
  const std::vector<Eigen::Vector3f> points = points_of(table);
  const bool any_is = std::any_of(points.begin(), points.end(), is_somewhere);
  std::optional<FirstAndLast> found;
  for (std::size_t row = 0; row < table.rows; ++row) {
    const RawTime time = times.at(row);
    if ((any_is && !is_somewhere(points[row])) || !std::isfinite(time.floating)) continue;
    if (!found) found = FirstAndLast{time, time};
    ++found->points;
    if (times.difference(time, found->first) < 0) found->first = time;
    if (times.difference(time, found->last) > 0) found->last = time;
  }
  return found;
}

/// The reference of a scan's times, and their clock.
struct TimeOrigin {
  RawTime zero;
  PointClock clock = PointClock::kScans;
};

TimeOrigin origin_of(const TimeColumn& times, const FirstAndLast& ends, Stamp stamp, PointTimeUnit unit) {
  const double unit_s = seconds_of(unit);
  if (times.grain(ends.last) * unit_s > kCoarsest_s) return {{}, PointClock::kCoarse};
  if (are_constant(times, ends)) return {{}, PointClock::kConstant};
  const bool is_absolute = ends.first.floating * unit_s > kMaxOffset_s;
  const RawTime zero = is_absolute ? times.of_stamp(stamp, unit) : RawTime{};
  const double first_s = times.difference(ends.first, zero) * unit_s;
  const double last_s = times.difference(ends.last, zero) * unit_s;
  if (last_s - first_s <= kMaxShortSweep_s && (first_s > kFarthestSweep_s || last_s < -kFarthestSweep_s))
    return {ends.first, PointClock::kOther};
  return {zero, PointClock::kScans};
}

}  // namespace

const char* name_of(PointTimeUnit unit) {
  switch (unit) {
    case PointTimeUnit::kSecond:
      return "seconds";
    case PointTimeUnit::kMillisecond:
      return "milliseconds";
    case PointTimeUnit::kMicrosecond:
      return "microseconds";
    default:
      return "nanoseconds";
  }
}

std::optional<RawPointTimes> raw_times_of(const PointTable& table) {
  const PointColumn* column = find_time_column(table);
  if (column == nullptr) return std::nullopt;
  const TimeColumn times(table, *column);
  const auto ends = first_and_last(table, times);
  if (!ends) return std::nullopt;
  return RawPointTimes{times.nominal_unit(ends->first), times.difference(ends->last, ends->first),
                       ends->first.floating};
}

bool are_frozen(const std::vector<RawPointTimes>& scans, double duration_s, PointTimeUnit unit) {
  if (scans.size() < kMinScansToFreeze) return false;
  const auto by_first = [](const RawPointTimes& a, const RawPointTimes& b) { return a.first < b.first; };
  const auto [least, greatest] = std::minmax_element(scans.begin(), scans.end(), by_first);
  const double unit_s = seconds_of(unit);
  return least->first * unit_s > kMaxOffset_s &&
         (greatest->first - least->first) * unit_s < kFrozenShare * duration_s;
}

PointTimeUnit unit_of(const std::vector<RawPointTimes>& scans, double interval_s) {
  RADIOSLAM_CHECK(!scans.empty() && interval_s > 0, "the unit is determined from consecutive scans");
  std::vector<double> spans;
  for (const RawPointTimes& scan : scans) spans.push_back(scan.span);
  const double span = upper_median(spans);
  const PointTimeUnit nominal = scans.front().nominal;
  const double nominal_s = span * seconds_of(nominal);
  const double min_s = kMinSweep * std::min(interval_s, 1.0);
  if (span == 0 || (nominal_s >= min_s && nominal_s <= kMaxSweep * interval_s)) return nominal;
  const auto fits = std::find_if(kUnits.begin(), kUnits.end(), [&](PointTimeUnit unit) {
    return span * seconds_of(unit) <= kMaxSweep * interval_s;
  });
  return fits != kUnits.end() && span * seconds_of(*fits) >= min_s ? *fits : nominal;
}

PointTimes times_of(const PointTable& table, Stamp stamp, std::optional<PointTimeUnit> unit) {
  const PointColumn* column = find_time_column(table);
  if (column == nullptr) return {};
  const TimeColumn times(table, *column);
  PointTimes result;
  const auto ends = first_and_last(table, times);
  const PointTimeUnit found = unit ? *unit : times.nominal_unit(ends ? ends->first : RawTime{});
  const TimeOrigin origin = ends ? origin_of(times, *ends, stamp, found) : TimeOrigin{};
  result.clock = origin.clock;
  if (origin.clock == PointClock::kCoarse || origin.clock == PointClock::kConstant) return result;
  result.since_stamp_s.resize(table.rows);
  for (std::size_t row = 0; row < table.rows; ++row)
    result.since_stamp_s[row] =
        static_cast<float>(times.difference(times.at(row), origin.zero) * seconds_of(found));
  return result;
}

}  // namespace radioslam
