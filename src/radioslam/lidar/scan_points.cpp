#include "radioslam/lidar/scan_points.hpp"

#include <cmath>

#include "radioslam/base/check.hpp"
#include "radioslam/base/statistics.hpp"
#include "radioslam/lidar/deskew.hpp"

namespace radioslam {

ScanPoints filter_and_deskew(const LidarScan& scan, const SE3::Tangent& twist_per_s,
                             const ScanPointParams& params) {
  return filter_and_deskew(
      scan, [&](double time_s) { return SE3::exp(time_s * twist_per_s); }, params);
}

ScanPoints filter_and_deskew(const LidarScan& scan, const std::function<SE3(double time_s)>& pose_at,
                             const ScanPointParams& params) {
  RADIOSLAM_CHECK(scan.times_s.empty() || scan.times_s.size() == scan.points.size(),
                  "one time per point, or none");
  const FloatScanMotion motion(scan.times_s, static_cast<float>(params.max_time_s), pose_at);
  const auto near_squared = static_cast<float>(params.min_range_m * params.min_range_m);
  const auto far_squared = static_cast<float>(params.max_range_m * params.max_range_m);
  ScanPoints result;
  result.points.reserve(scan.points.size());
  for (std::size_t k = 0; k < scan.points.size(); ++k) {
    const Eigen::Vector3f& point = scan.points[k];
    const float squared = point.squaredNorm();
    if (!point.allFinite() || (motion.is_timed() && !std::isfinite(scan.times_s[k]))) {
      ++result.counts.not_finite;
    } else if (motion.is_timed() && !motion.covers(scan.times_s[k])) {
      ++result.counts.off_time;
    } else if (squared < near_squared) {
      ++result.counts.near;
    } else if (!(squared <= far_squared)) {
      ++result.counts.far;
    } else {
      result.points.push_back(motion.is_timed() ? motion.carry(point, scan.times_s[k]) : point);
      if (motion.is_timed()) result.times_s.push_back(scan.times_s[k]);
      if (!scan.intensities.empty()) result.intensities.push_back(scan.intensities[k]);
    }
  }
  result.counts.used = result.points.size();
  if (!result.times_s.empty())
    result.middle_s = upper_median(std::vector<double>(result.times_s.begin(), result.times_s.end()));
  return result;
}

}  // namespace radioslam
