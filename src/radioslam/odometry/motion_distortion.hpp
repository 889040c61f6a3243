// Covariance that the remaining motion distortion of a deskewed scan adds to its pose.
//
//   a = (v - v') / T   change of motion: twists v, v' of two successive intervals T between scans, per body
//                      axis; kept as an exponentially weighted mean square
//   constant velocity  the motion between the last two sweeps' middles is half an interval old: at time t
//                      from the middle a point is off by a t T/2, over a sweep of length s by
//                      d = a s T / (4 sqrt 3) rms. The pose is right in the sweep's middle but for a
//                      fraction of that; at its stamp, m before the middle, it is off by a m (T - m) / 2
//   by odometry        linear between samples h apart: d = a h^2 / sqrt 120 rms, at the stamp as well
//   by the IMU         negligible at its rate
// A rotational distortion d (rms) of a full revolution also shifts it: the mean over the azimuth of points at
// range r is off by sqrt(3) / pi r d.
#pragma once

#include <optional>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/lidar/deskew.hpp"

namespace radioslam {

class DistortionCovariance {
 public:
  /// `newest_ratio`: weight of the newest change of motion in the mean. `interval_s`: nominal time between
  /// scans; scans less than half of it after another are ignored.
  DistortionCovariance(double newest_ratio, double interval_s)
      : newest_ratio_(newest_ratio), nominal_s_(interval_s) {}

  /// Adds the next scan's pose, in an arbitrary common frame; stamps increase.
  void add(Stamp stamp, const SE3& T_start_body);

  /// The next scan is on a new map: its pose gives no motion from the previous one.
  void start_new_map();

  /// Variances of a scan's pose in its body frame, per axis [m^2; rad^2]; `sample_interval_s`: time between
  /// recorded odometry samples; `range_m`: of the points. Zero before the third scan.
  SE3::Tangent variances(MotionSource source, const ScanTimeSpan& time, double sample_interval_s,
                         double range_m) const;

 private:
  double newest_ratio_, nominal_s_;
  std::optional<StampedPose<SE3>> last_;
  std::optional<SE3::Tangent> twist_per_s_;
  double interval_s_ = 0;  ///< between the last two scans
  double changes_ = 0;
  SE3::Tangent squares_per_s4_ = SE3::Tangent::Zero();  ///< of a
};

}  // namespace radioslam
