#include "radioslam/odometry/motion_distortion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace radioslam {

void DistortionCovariance::add(Stamp stamp, const SE3& T_start_body) {
  const StampedPose<SE3> newest{stamp, T_start_body};
  const StampedPose<SE3> previous = last_.value_or(newest);
  const double interval_s = seconds_between(previous.stamp, stamp);
  if (last_ && interval_s < nominal_s_ / 2) return;
  last_ = newest;
  if (interval_s <= 0) return;
  interval_s_ = interval_s;
  const SE3::Tangent twist_per_s = (previous.pose.inverse() * T_start_body).log() / interval_s;
  if (twist_per_s_) {
    const SE3::Tangent change_per_s2 = (twist_per_s - *twist_per_s_) / interval_s;
    const double newest_ratio = std::max(newest_ratio_, 1 / ++changes_);
    squares_per_s4_ += newest_ratio * (change_per_s2.cwiseAbs2() - squares_per_s4_);
  }
  twist_per_s_ = twist_per_s;
}

void DistortionCovariance::start_new_map() {
  last_.reset();
  twist_per_s_.reset();
}

SE3::Tangent DistortionCovariance::variances(MotionSource source, const ScanTimeSpan& time,
                                             double sample_interval_s, double range_m) const {
  constexpr double kMiddleRatio = 0.2;  // of the points' mean square; measured 0.18 in rooms
  constexpr double kShift = 3 / (std::numbers::pi * std::numbers::pi);
  const double swept_s = time.last_s - time.first_s, before_s = time.middle_s;
  if (source == MotionSource::kImu || swept_s <= 0) return SE3::Tangent::Zero();
  double points_s4 = std::pow(sample_interval_s, 4) / 120, pose_s4 = points_s4;
  if (source == MotionSource::kConstantVelocity) {
    points_s4 = std::pow(swept_s * interval_s_, 2) / 48;
    pose_s4 = kMiddleRatio * points_s4 + std::pow(before_s * (interval_s_ - before_s) / 2, 2);
  }
  SE3::Tangent variances = pose_s4 * squares_per_s4_;
  const Eigen::Array3d turns = points_s4 * squares_per_s4_.tail<3>().array();
  variances.head<3>().array() += kShift * range_m * range_m * (turns.sum() - turns);
  return variances;
}

}  // namespace radioslam
