#include "radioslam/lidar/scan_points.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "radioslam/base/check.hpp"
#include "radioslam/base/median.hpp"

namespace radioslam {
namespace {

/// Exp(time * twist) at so many times that a point between two of them is off by next to nothing.
class SweptMotion {
 public:
  SweptMotion(const LidarScan& scan, const SE3::Tangent& twist_per_s, double most_time_s)
      : is_timed_(!scan.times_s.empty()), most_time_s_(static_cast<float>(most_time_s)) {
    float last_s = -most_time_s_;
    first_s_ = most_time_s_;
    for (const float time_s : scan.times_s) {
      if (!covers(time_s)) continue;
      first_s_ = std::min(first_s_, time_s);
      last_s = std::max(last_s, time_s);
    }
    if (last_s < first_s_) return;
    step_s_ = std::max(1e-9F, (last_s - first_s_) / static_cast<float>(kSteps));
    for (int k = 0; k <= kSteps; ++k) {
      const SE3 T = SE3::exp(static_cast<double>(first_s_ + static_cast<float>(k) * step_s_) * twist_per_s);
      rotations_.push_back(T.rotation_matrix().cast<float>());
      translations_.push_back(T.translation().cast<float>());
    }
  }

  bool is_timed() const { return is_timed_; }

  /// Not where it is no number.
  bool covers(float time_s) const { return std::abs(time_s) <= most_time_s_; }

  Eigen::Vector3f carry(const Eigen::Vector3f& point, float time_s) const {
    const auto k = static_cast<std::size_t>(std::lround((time_s - first_s_) / step_s_));
    return rotations_[k] * point + translations_[k];
  }

 private:
  static constexpr int kSteps = 256;
  bool is_timed_;
  float most_time_s_;
  float first_s_ = 0, step_s_ = 1;
  std::vector<Eigen::Matrix3f> rotations_;
  std::vector<Eigen::Vector3f> translations_;
};

}  // namespace

ScanPoints usable_points(const LidarScan& scan, const SE3::Tangent& twist_per_s,
                         const ScanPointParams& params) {
  RADIOSLAM_CHECK(scan.times_s.empty() || scan.times_s.size() == scan.points.size(),
                  "a time per point or none");
  const SweptMotion motion(scan, twist_per_s, params.most_time_s);
  const auto near_squared = static_cast<float>(params.least_range_m * params.least_range_m);
  const auto far_squared = static_cast<float>(params.most_range_m * params.most_range_m);
  ScanPoints result;
  result.points.reserve(scan.points.size());
  std::vector<double> times_s;
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
      if (motion.is_timed()) times_s.push_back(static_cast<double>(scan.times_s[k]));
    }
  }
  result.counts.used = result.points.size();
  if (!times_s.empty()) result.middle_s = upper_median(std::move(times_s));
  return result;
}

}  // namespace radioslam
