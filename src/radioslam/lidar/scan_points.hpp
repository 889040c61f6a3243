// Filters a scan's points and deskews them by the motion of the body over the sweep (deskew.hpp).
//
// Points are dropped if they or their times are not finite, if they are nearer than `min_range_m` (the robot
// itself) or farther than `max_range_m`, or if their time is more than `max_time_s` from the stamp.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/mission/lidar.hpp"

namespace radioslam {

// Which points of a scan are used: limits of their range and of their time.

struct ScanPointParams {
  double min_range_m = 0.3;
  double max_range_m = 100;
  double max_time_s = 60;  ///< slow scanners sweep for seconds

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(min_range_m, "m", 0, 100,
                          "smallest range of a point; nearer ones are taken for the robot itself");
    RADIOSLAM_BASIC_FIELD(max_range_m, "m", 0.1, 1000, "largest range of a point; farther ones are ignored");
    RADIOSLAM_FIELD(max_time_s, "s", 1e-3, 1e6,
                    "largest time between a point and its scan's stamp; points beyond it are ignored");
  }
};

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
  std::vector<float> intensities;       ///< of each point; empty if not recorded
  PointCounts counts;
  double middle_s = 0;  ///< median of the times; 0 without times
};

/// `pose_at(time_s)`: of the body in its frame at the stamp; not called for scans without point times.
ScanPoints filter_and_deskew(const LidarScan& scan, const std::function<SE3(double time_s)>& pose_at,
                             const ScanPointParams& params);

/// `twist_per_s`: of the body, T(t) = T(stamp) Exp(t twist); unused for scans without point times.
ScanPoints filter_and_deskew(const LidarScan& scan, const SE3::Tangent& twist_per_s,
                             const ScanPointParams& params);

}  // namespace radioslam
