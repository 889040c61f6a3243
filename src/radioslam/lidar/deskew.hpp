// Deskewing: moves the points of a scan to where the body frame at the scan's stamp saw them.
//
//   p(stamp) = T(t) p(t)     T(t): pose of the body at time t of the sweep, in its frame at the stamp
//
// T is tabulated at evenly spaced times, so densely that using the nearest pose causes a negligible error. It
// is either a constant velocity, T(t) = Exp(t twist), or comes from recorded odometry or an IMU, which does
// not lag where a turn begins or ends. Times are relative to the stamp; a time that is not finite or farther
// from it than `max_time_s` is impossible.
// Cost: 257 poses, and one rotation per point.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/lidar/scan_points.hpp"
#include "radioslam/lidar/surfels/surfel.hpp"
#include "radioslam/mission/lidar.hpp"

namespace radioslam {

/// Where the motion comes from that predicts a scan's pose and deskews it.
enum class MotionSource { kConstantVelocity, kOdometry, kImu };

/// Times of a scan's points: first, median, last.
struct ScanTimeSpan {
  double first_s = 0, middle_s = 0, last_s = 0;
};

/// Of the possible times; all zero if there are none.
ScanTimeSpan time_span(const LidarScan& scan, const ScanPointParams& params);

/// Evenly spaced times.
template <class Real>
struct TimeGrid {
  Real first_s = 0, step_s = 0;
  std::size_t last = 0;  ///< index of the last time

  Real time_of(std::size_t k) const { return first_s + static_cast<Real>(k) * step_s; }
  std::size_t nearest(Real time_s) const {
    if (!(step_s > 0)) return 0;
    const Real steps = std::clamp((time_s - first_s) / step_s, Real{0}, static_cast<Real>(last));
    return static_cast<std::size_t>(std::lround(steps));
  }
};

/// Motion of the body over a scan: T at evenly spaced times from time.first_s to time.last_s.
struct ScanMotion {
  ScanTimeSpan time;
  std::vector<SE3> poses;  ///< at least one

  /// A table of identity poses, to be filled in.
  static ScanMotion over(const ScanTimeSpan& time);

  TimeGrid<double> grid() const;
  double time_of(std::size_t k) const { return grid().time_of(k); }
  std::size_t nearest(double time_s) const { return grid().nearest(time_s); }
  const SE3& middle() const { return poses[nearest(time.middle_s)]; }
};

/// The same, computed in the single precision of points and their times.
class FloatScanMotion {
 public:
  /// Over the possible ones of `times_s`; `pose_at(time_s)` is T.
  FloatScanMotion(const std::vector<float>& times_s, float max_time_s,
                  const std::function<SE3(double time_s)>& pose_at);

  bool is_timed() const { return is_timed_; }
  /// Whether a time is possible.
  bool covers(float time_s) const { return std::abs(time_s) <= max_time_s_; }  // false for NaN

  Eigen::Vector3f carry(const Eigen::Vector3f& point, float time_s) const {
    const std::size_t k = grid_.nearest(time_s);
    return rotations_[k] * point + translations_[k];
  }
  Surfel carry(const Surfel& surfel, float time_s) const {
    const std::size_t k = grid_.nearest(time_s);
    return transformed(rotations_[k], translations_[k], surfel);
  }

 private:
  bool is_timed_;
  float max_time_s_;
  TimeGrid<float> grid_;
  std::vector<Eigen::Matrix3f> rotations_;
  std::vector<Eigen::Vector3f> translations_;
};

/// The deskewed scan, without times. Points that are not used stay as they are; those with an impossible time
/// become NaN.
LidarScan deskew(LidarScan scan, const ScanMotion& motion, const ScanPointParams& params);

/// Surfels that were deskewed by the twist `was_per_s`, deskewed by `is_per_s` instead. Without `times_s`
/// they stay unchanged.
std::vector<Surfel> re_deskew(const std::vector<Surfel>& surfels, const std::vector<float>& times_s,
                              const SE3::Tangent& was_per_s, const SE3::Tangent& is_per_s);

}  // namespace radioslam
