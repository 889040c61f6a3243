// Where the body was while a scan was swept, as readings or recorded odometry tell it, and the scan as it
// would be had the body stood at its place at the stamp:
//   p(stamp) = T_body(time) p
// A constant motion since the scan before (lidar/scan_points.hpp) lags where the body begins or ends a turn.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/lidar/scan_points.hpp"
#include "radioslam/mission/lidar.hpp"

namespace radioslam {

/// When the points of a scan were measured, since its stamp.
struct SweptTime {
  double first_s = 0, middle_s = 0, last_s = 0;
};

/// All zero for a scan without times.
SweptTime swept_time(const LidarScan& scan, const ScanPointParams& params);

/// Poses in the body frame at the stamp, evenly spaced in time.
struct SweptWay {
  SweptTime time;
  std::vector<SE3> poses;  ///< at least one; from time.first_s to time.last_s

  /// So many that a point between two of them is off by next to nothing; none is known yet.
  static SweptWay over(const SweptTime& time);

  double time_of(std::size_t k) const;
  std::size_t nearest(double time_s) const;
  const SE3& middle() const { return poses[nearest(time.middle_s)]; }
};

/// The scan without times. Points that cannot be used stay as they are, or are no number where their time is
/// impossible.
LidarScan unbent(LidarScan scan, const SweptWay& way, const ScanPointParams& params);

}  // namespace radioslam
