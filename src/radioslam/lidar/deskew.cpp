#include "radioslam/lidar/deskew.hpp"

#include <Eigen/Geometry>
#include <limits>
#include <utility>

#include "radioslam/base/check.hpp"
#include "radioslam/base/statistics.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kSteps = 256;  // of a tabulated motion

bool is_possible_time(float time_s, const ScanPointParams& params) {
  return std::abs(static_cast<double>(time_s)) <= params.max_time_s;  // false for NaN
}

}  // namespace

ScanTimeSpan time_span(const LidarScan& scan, const ScanPointParams& params) {
  std::vector<double> times_s;
  for (const float time_s : scan.times_s)
    if (is_possible_time(time_s, params)) times_s.push_back(static_cast<double>(time_s));
  if (times_s.empty()) return {};
  const auto [first, last] = std::minmax_element(times_s.begin(), times_s.end());
  ScanTimeSpan time{*first, 0, *last};
  time.middle_s = upper_median(std::move(times_s));
  return time;
}

ScanMotion ScanMotion::over(const ScanTimeSpan& time) {
  return {time, std::vector<SE3>(time.first_s < time.last_s ? kSteps + 1 : 1)};
}

TimeGrid<double> ScanMotion::grid() const {
  const std::size_t last = poses.size() - 1;
  const double step_s = (time.last_s - time.first_s) / static_cast<double>(std::max<std::size_t>(1, last));
  return {time.first_s, step_s, last};
}

FloatScanMotion::FloatScanMotion(const std::vector<float>& times_s, float max_time_s,
                                 const std::function<SE3(double time_s)>& pose_at)
    : is_timed_(!times_s.empty()), max_time_s_(max_time_s) {
  float first_s = max_time_s, last_s = -max_time_s;
  for (const float time_s : times_s) {
    if (!covers(time_s)) continue;
    first_s = std::min(first_s, time_s);
    last_s = std::max(last_s, time_s);
  }
  if (last_s < first_s) return;
  grid_ = {first_s, std::max(1e-9F, (last_s - first_s) / static_cast<float>(kSteps)), kSteps};
  for (std::size_t k = 0; k <= kSteps; ++k) {
    const SE3 T = pose_at(static_cast<double>(grid_.time_of(k)));
    rotations_.push_back(T.rotation_matrix().cast<float>());
    translations_.push_back(T.translation().cast<float>());
  }
}

LidarScan deskew(LidarScan scan, const ScanMotion& motion, const ScanPointParams& params) {
  if (scan.times_s.empty()) return scan;
  std::vector<Eigen::Isometry3f> carry;
  for (const SE3& pose : motion.poses) {
    carry.push_back(Eigen::Isometry3f::Identity());
    carry.back().linear() = pose.rotation_matrix().cast<float>();
    carry.back().translation() = pose.translation().cast<float>();
  }
  const TimeGrid<double> grid = motion.grid();
  const auto near = static_cast<float>(params.min_range_m);
  for (std::size_t k = 0; k < scan.points.size(); ++k) {
    Eigen::Vector3f& point = scan.points[k];
    if (!is_possible_time(scan.times_s[k], params))
      point.setConstant(std::numeric_limits<float>::quiet_NaN());
    else if (point.norm() >= near)
      point = carry[grid.nearest(static_cast<double>(scan.times_s[k]))] * point;
  }
  scan.times_s.clear();
  return scan;
}

std::vector<Surfel> re_deskew(const std::vector<Surfel>& surfels, const std::vector<float>& times_s,
                              const SE3::Tangent& was_per_s, const SE3::Tangent& is_per_s) {
  const FloatScanMotion motion(times_s, std::numeric_limits<float>::max(), [&](double time_s) {
    return SE3::exp(time_s * is_per_s) * SE3::exp(time_s * was_per_s).inverse();
  });
  if (!motion.is_timed()) return surfels;
  RADIOSLAM_CHECK(times_s.size() == surfels.size(), "one time per surfel");
  std::vector<Surfel> carried;
  carried.reserve(surfels.size());
  for (std::size_t k = 0; k < surfels.size(); ++k) carried.push_back(motion.carry(surfels[k], times_s[k]));
  return carried;
}

}  // namespace radioslam
