#include "radioslam/pipeline/sweep_bend.hpp"

#include <algorithm>

namespace radioslam {

void SweepBend::add(Stamp stamp, const SE3& T_start_body) {
  const StampedPose<SE3> previous = last_.value_or(StampedPose<SE3>{stamp, T_start_body});
  last_ = {stamp, T_start_body};
  interval_s_ = seconds_between(previous.stamp, stamp);
  if (interval_s_ <= 0) return;
  const SE3::Tangent twist_per_s = (previous.pose.inverse() * T_start_body).log() / interval_s_;
  if (twist_per_s_) {
    const SE3::Tangent change_per_s2 = (twist_per_s - *twist_per_s_) / interval_s_;
    squares_per_s4_ += newest_share_ * (change_per_s2.cwiseAbs2() - squares_per_s4_);
  }
  twist_per_s_ = twist_per_s;
}

SE3::Tangent SweepBend::variances(SweptBy by, double over_s, double range_m) const {
  double off_s4 = 0;
  if (by == SweptBy::kScans) off_s4 = over_s * over_s * interval_s_ * interval_s_ / 48;
  if (by == SweptBy::kRecordedRows) off_s4 = over_s * over_s * over_s * over_s / 120;
  SE3::Tangent variances = off_s4 * squares_per_s4_;
  const Eigen::Vector3d turns = variances.tail<3>();
  variances.head<3>().array() += range_m * range_m * (turns.sum() - turns.array());
  return variances;
}

}  // namespace radioslam
