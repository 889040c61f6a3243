// When the points of a scan were measured, from a column of times whose unit and clock nobody tells.
//
// The column is the first one named t, time, timestamp, offset_time or time_offset. Its usual unit is the
// nanosecond of whole numbers and the second of others, or the nanosecond from 1e12 on. A sweep lasts about
// as long as the next one takes to come: where the interval between scans is known, the unit in which a sweep
// lasts from a hundredth of it (or of a second) to twice as long is taken, the usual one where that fits,
// else the largest that is not too long.
//
// Times are since the scan's stamp, or absolute from 1e6 s on. Where a sweep of a second or less lies
// altogether more than a second off its stamp, two clocks differ, and its first point is taken to be at the
// stamp. Times that a float32 cannot tell apart by a millisecond are none. First and last
// are those of the points that are somewhere: what stands for no return often has no time either.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/io/point_table.hpp"

namespace radioslam {

enum class PointTimeUnit { kSecond, kMillisecond, kMicrosecond, kNanosecond };

/// "seconds", and so on.
const char* name_of(PointTimeUnit unit);

/// Whose clock the points' times are of.
enum class PointClock {
  kScans,   ///< that of the scan's stamp, or there are no times
  kOther,   ///< another one; they begin at the stamp
  kCoarse,  ///< no clock: too coarse, and left out
};

/// The times of a scan as they stand, in a unit that is yet to be found.
struct RawPointTimes {
  PointTimeUnit usual = PointTimeUnit::kSecond;
  double span = 0;  ///< from the first to the last point
};

struct PointTimes {
  std::vector<float> since_stamp_s;  ///< a time per point, or none at all; what is not finite stays so
  PointClock clock = PointClock::kScans;
};

/// Nothing where the table has no times. The table is one that points_of takes.
std::optional<RawPointTimes> raw_times_of(const PointTable& table);

/// The unit of scans of these spans that come `interval_s` (> 0) apart, judged by the median one. `scans` has
/// at least one.
PointTimeUnit unit_of(const std::vector<RawPointTimes>& scans, double interval_s);

/// In the usual unit where `unit` tells none. Linear in the points.
PointTimes times_of(const PointTable& table, Stamp stamp, std::optional<PointTimeUnit> unit = std::nullopt);

}  // namespace radioslam
