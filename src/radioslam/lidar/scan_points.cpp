#include "radioslam/lidar/scan_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "radioslam/base/check.hpp"

namespace radioslam {
namespace {

/// Exp(time * twist) at so many times that a point between two of them is off by next to nothing. Times that
/// are no numbers do not count.
class SweptMotion {
 public:
  SweptMotion(const std::vector<float>& times_s, const SE3::Tangent& twist_per_s) {
    float last_s = -std::numeric_limits<float>::infinity();
    first_s_ = -last_s;
    for (const float time_s : times_s) {
      if (!std::isfinite(time_s)) continue;
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

  Eigen::Vector3f carry(const Eigen::Vector3f& point, float time_s) const {
    const auto k = static_cast<std::size_t>(std::lround((time_s - first_s_) / step_s_));
    return rotations_[k] * point + translations_[k];
  }

 private:
  static constexpr int kSteps = 256;
  float first_s_ = 0, step_s_ = 1;
  std::vector<Eigen::Matrix3f> rotations_;
  std::vector<Eigen::Vector3f> translations_;
};

}  // namespace

ScanPoints usable_points(const LidarScan& scan, const SE3::Tangent& twist_per_s,
                         const ScanPointParams& params) {
  RADIOSLAM_CHECK(scan.times_s.empty() || scan.times_s.size() == scan.points.size(),
                  "a time per point or none");
  const SweptMotion motion(scan.times_s, twist_per_s);
  const auto near_squared = static_cast<float>(params.least_range_m * params.least_range_m);
  const auto far_squared = static_cast<float>(params.most_range_m * params.most_range_m);
  ScanPoints result;
  result.points.reserve(scan.points.size());
  for (std::size_t k = 0; k < scan.points.size(); ++k) {
    const Eigen::Vector3f& point = scan.points[k];
    const bool is_timed = !scan.times_s.empty();
    if (!point.allFinite() || (is_timed && !std::isfinite(scan.times_s[k]))) {
      ++result.counts.not_finite;
    } else if (point.squaredNorm() < near_squared) {
      ++result.counts.near;
    } else {
      const Eigen::Vector3f at_stamp = is_timed ? motion.carry(point, scan.times_s[k]) : point;
      if (at_stamp.squaredNorm() <= far_squared)
        result.points.push_back(at_stamp);
      else
        ++result.counts.far;
    }
  }
  result.counts.used = result.points.size();
  return result;
}

}  // namespace radioslam
