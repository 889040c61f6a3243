// Filters a scan's points and deskews them by a constant twist of the body over the sweep (deskew.hpp).
//
// Points are dropped if they or their times are not finite, if they are nearer than `min_range_m` (the robot
// itself) or farther than `max_range_m`, or if their time is more than `max_time_s` from the stamp.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/lidar/scan_point_params.hpp"
#include "radioslam/mission/lidar.hpp"

namespace radioslam {

/// Number of used and dropped points of one or more scans.
struct PointCounts {
  std::size_t used = 0;
  std::size_t not_finite = 0;  ///< the point or its time
  std::size_t near = 0, far = 0;
  std::size_t off_time = 0;  ///< farther from the stamp than max_time_s

  void operator+=(const PointCounts& other) {
    used += other.used;
    not_finite += other.not_finite;
    off_time += other.off_time;
    near += other.near;
    far += other.far;
  }
};

struct ScanPoints {
  std::vector<Eigen::Vector3f> points;  ///< in the body frame at the scan's stamp
  std::vector<float> times_s;           ///< of each point since the stamp; empty if unknown
  PointCounts counts;
  double middle_s = 0;  ///< median of the times; 0 without times
};

/// `twist_per_s`: of the body, T(t) = T(stamp) Exp(t twist); unused for scans without point times.
ScanPoints filter_and_deskew(const LidarScan& scan, const SE3::Tangent& twist_per_s,
                             const ScanPointParams& params);

}  // namespace radioslam
