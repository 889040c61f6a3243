#include "radioslam/lidar/scan_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "radioslam/base/check.hpp"
#include "radioslam/base/median.hpp"

namespace radioslam {
namespace {

/// A motion at so many times that a point between two of them is off by next to nothing.
class SweptMotion {
 public:
  /// `pose_at(time_s)`: of the body, at these times.
  template <class PoseAt>
  SweptMotion(const std::vector<float>& times_s, float most_time_s, const PoseAt& pose_at)
      : is_timed_(!times_s.empty()), most_time_s_(most_time_s), first_s_(most_time_s) {
    float last_s = -most_time_s_;
    for (const float time_s : times_s) {
      if (!covers(time_s)) continue;
      first_s_ = std::min(first_s_, time_s);
      last_s = std::max(last_s, time_s);
    }
    if (last_s < first_s_) return;
    step_s_ = std::max(1e-9F, (last_s - first_s_) / static_cast<float>(kSteps));
    for (int k = 0; k <= kSteps; ++k) {
      const SE3 T = pose_at(static_cast<double>(first_s_ + static_cast<float>(k) * step_s_));
      rotations_.push_back(T.rotation_matrix().cast<float>());
      translations_.push_back(T.translation().cast<float>());
    }
  }

  bool is_timed() const { return is_timed_; }

  /// Not where it is no number.
  bool covers(float time_s) const { return std::abs(time_s) <= most_time_s_; }

  Eigen::Vector3f carry(const Eigen::Vector3f& point, float time_s) const {
    const std::size_t k = step_at(time_s);
    return rotations_[k] * point + translations_[k];
  }

  Surfel carry(const Surfel& surfel, float time_s) const {
    const std::size_t k = step_at(time_s);
    return transformed(rotations_[k], translations_[k], surfel);
  }

 private:
  std::size_t step_at(float time_s) const {
    return static_cast<std::size_t>(std::lround((time_s - first_s_) / step_s_));
  }

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
  const SweptMotion motion(scan.times_s, static_cast<float>(params.most_time_s),
                           [&](double time_s) { return SE3::exp(time_s * twist_per_s); });
  const auto near_squared = static_cast<float>(params.least_range_m * params.least_range_m);
  const auto far_squared = static_cast<float>(params.most_range_m * params.most_range_m);
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
    }
  }
  result.counts.used = result.points.size();
  if (!result.times_s.empty())
    result.middle_s = upper_median(std::vector<double>(result.times_s.begin(), result.times_s.end()));
  return result;
}

std::vector<Surfel> carried_anew(const std::vector<Surfel>& surfels, const std::vector<float>& times_s,
                                 const SE3::Tangent& was_per_s, const SE3::Tangent& is_per_s) {
  const SweptMotion motion(times_s, std::numeric_limits<float>::max(), [&](double time_s) {
    return SE3::exp(time_s * is_per_s) * SE3::exp(time_s * was_per_s).inverse();
  });
  if (!motion.is_timed()) return surfels;
  RADIOSLAM_CHECK(times_s.size() == surfels.size(), "a time per surfel");
  std::vector<Surfel> carried;
  carried.reserve(surfels.size());
  for (std::size_t k = 0; k < surfels.size(); ++k) carried.push_back(motion.carry(surfels[k], times_s[k]));
  return carried;
}

}  // namespace radioslam
