// The points of a scan that can be used, where they were at the scan's stamp.
//
// Left out are points that are not finite or have times that are not, that are nearer than the scanner's own
// robot or farther than what returns from one surface can be told from another's. A scan swept while the
// robot moved is bent; each point is carried along the motion, taken as a constant twist, to where the
// stamp's body frame saw it:
//   p(stamp) = Exp(time * twist) p
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/lidar/surfel.hpp"
#include "radioslam/mission/lidar.hpp"

namespace radioslam {

struct ScanPointParams {
  double least_range_m = 0.3;
  double most_range_m = 100;
  double most_time_s = 60;  ///< from the stamp: slow scanners sweep for seconds

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"least_range_m", "m", 0, 100, "nearer points are the robot's own"}, self.least_range_m);
    visit(Field{"most_range_m", "m", 0.1, 1000, "farther points are left out"}, self.most_range_m);
    visit(Field{"most_time_s", "s", 1e-3, 1e6, "points farther from their scan's stamp are left out"},
          self.most_time_s);
  }
};

/// What became of the points of one scan, or of many.
struct PointCounts {
  std::size_t used = 0;
  std::size_t not_finite = 0;  ///< or of a time that is not
  std::size_t near = 0, far = 0;
  std::size_t off_time = 0;  ///< farther from the stamp than most_time_s

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
  std::vector<float> times_s;           ///< of each since the stamp; empty where not known
  PointCounts counts;
  double middle_s = 0;  ///< median of their times; 0 without any
};

/// `twist_per_s`: of the body, T(t) = T(stamp) Exp(t twist); it counts where the scan tells its points'
/// times.
ScanPoints usable_points(const LidarScan& scan, const SE3::Tangent& twist_per_s,
                         const ScanPointParams& params);

/// Surfels of points that were carried along one twist, carried along another instead. `times_s` is of each,
/// or empty: then they stay.
std::vector<Surfel> carried_anew(const std::vector<Surfel>& surfels, const std::vector<float>& times_s,
                                 const SE3::Tangent& was_per_s, const SE3::Tangent& is_per_s);

}  // namespace radioslam
