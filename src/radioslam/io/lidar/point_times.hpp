// Times of a scan's points, from a column of times with unknown unit and clock.
//
// The column is the first one named t, time, timestamp, offset_time or time_offset. Its nominal unit is
// nanoseconds for integers and for values from 1e12 on, otherwise seconds. A sweep lasts about as long as the
// interval between scans. If that interval is known, the unit is chosen such that a sweep lasts between a
// hundredth of it (or of a second) and twice its length: the nominal unit if that fits, otherwise the largest
// unit that is not too long.
//
// Times are relative to the scan's stamp, or absolute from 1e6 s on. If a sweep of at most one second lies
// entirely more than one second off its stamp, the two clocks differ, and its first point is assigned the
// stamp. Times that are equal for all points of a scan say nothing of its sweep and are discarded, as are
// times in float32 that cannot resolve a millisecond. The first and last times are those
// of points with finite, non-zero coordinates, because missing returns often have no valid time.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/io/lidar/point_table.hpp"

namespace radioslam {

enum class PointTimeUnit { kSecond, kMillisecond, kMicrosecond, kNanosecond };

/// Name of a unit: "seconds", ...
const char* name_of(PointTimeUnit unit);

/// The clock of the points' times.
enum class PointClock {
  kScans,   ///< the clock of the scan's stamp, or no times
  kOther,   ///< another clock; the times are shifted to begin at the stamp
  kCoarse,  ///< times are too coarse and were discarded
  /// All points of a scan have one time, or all scans the same absolute ones; discarded.
  kConstant,
};

/// Nominal unit and span of a scan's times, before the unit is determined.
struct RawPointTimes {
  PointTimeUnit nominal = PointTimeUnit::kSecond;
  double span = 0;  ///< from the first to the last point
  double first = 0;
};

struct PointTimes {
  std::vector<float> since_stamp_s;  ///< one per point, or empty; non-finite values are kept
  PointClock clock = PointClock::kScans;
};

/// The span of a table's times; nothing if it has none. points_of must accept the table.
std::optional<RawPointTimes> raw_times_of(const PointTable& table);

/// The unit of scans (at least one) that are `interval_s` (> 0) apart, determined from their median span.
PointTimeUnit unit_of(const std::vector<RawPointTimes>& scans, double interval_s);

/// Whether the absolute times of scans (three or more) whose stamps cover `duration_s` are the same in all.
bool are_frozen(const std::vector<RawPointTimes>& scans, double duration_s, PointTimeUnit unit);

/// The points' times in `unit`, by default the nominal one. Linear in the number of points.
PointTimes times_of(const PointTable& table, Stamp stamp, std::optional<PointTimeUnit> unit = std::nullopt);

}  // namespace radioslam
