#include "radioslam/mission/keyframe_choice.hpp"

#include <algorithm>
#include <cmath>

namespace radioslam {
namespace {

constexpr double kThinning = 0.05;  // of the allowed deviation, between samples that are looked at

/// The larger one of two, each relative to what is allowed.
double allowances(const SE3& off, const KeyframeParams& params) {
  const auto of = [](double by, double allowed) { return allowed > 0 ? by / allowed : 0; };
  return std::max(of(off.translation().norm(), params.max_deviation_m),
                  of(off.log().tail<3>().norm(), params.max_deviation_rad));
}

}  // namespace

Occasion occasion_of(Stamp stamp, const AoaPath& path) {
  Occasion occasion{stamp};
  occasion.sigma_rad = path.sigma_rad;
  return occasion;
}

Occasion occasion_of(Stamp stamp, const SE3::Jacobian& covariance) {
  const auto variances = covariance.diagonal();
  return {stamp, std::sqrt(variances.head<3>().minCoeff()), std::sqrt(variances.tail<3>().minCoeff())};
}

void KeyframeChoice::add(const StampedPose<SE3>& sample) {
  if (!keyframes_.empty()) bound_deviation(sample);
  if (keyframes_.empty() || is_new_keyframe(last_.pose, sample.pose, params_)) start(sample);
  if (allowances(way_.back().pose.inverse() * sample.pose, params_) >= kThinning) {
    if (way_.back().stamp < last_sample_.stamp) extend_way(last_sample_);
    extend_way(sample);
  }
  last_sample_ = sample;
}

void KeyframeChoice::add(Stamp stamp) {
  if (stamp <= last_.stamp) return;
  const StampedPose<SE3> here{stamp, *robot_.odometry.at(stamp)};
  bound_deviation(here);
  start(here);
}

bool KeyframeChoice::is_better_than_odometry(const Occasion& occasion) {
  const SE3::Tangent variances = motion_.at(occasion.stamp).T_keyframe_body.covariance.diagonal();
  return occasion.sigma_m <= 0 || variances.head<3>().maxCoeff() > occasion.sigma_m * occasion.sigma_m ||
         variances.tail<3>().maxCoeff() > occasion.sigma_rad * occasion.sigma_rad;
}

void KeyframeChoice::add(const Occasion& occasion) {
  if (is_better_than_odometry(occasion)) add(occasion.stamp);
}

void KeyframeChoice::finish() {
  if (!keyframes_.empty()) add(last_sample_.stamp);
}

void KeyframeChoice::start(const StampedPose<SE3>& keyframe) {
  keyframes_.push_back(keyframe.stamp);
  last_ = keyframe;
  way_ = {keyframe};
  farthest_ = 0;
}

void KeyframeChoice::extend_way(const StampedPose<SE3>& sample) {
  way_.push_back(sample);
  farthest_ = std::max(farthest_, allowances(last_.pose.inverse() * sample.pose, params_));
}

/// Makes the last sample a keyframe if the geodesic from the last one to `next` would leave the path.
void KeyframeChoice::bound_deviation(const StampedPose<SE3>& next) {
  const SE3 T_last_next = last_.pose.inverse() * next.pose;
  if (farthest_ + allowances(T_last_next, params_) <= 1) return;  // so is every point between
  const SE3::Tangent way = T_last_next.log();
  const double duration_s = seconds_between(last_.stamp, next.stamp);
  for (const StampedPose<SE3>& sample : way_) {
    const SE3 drawn = last_.pose * SE3::exp(seconds_between(last_.stamp, sample.stamp) / duration_s * way);
    if (allowances(drawn.inverse() * sample.pose, params_) > 1)
      return start(StampedPose<SE3>(last_sample_.stamp < next.stamp ? last_sample_ : sample));
  }
}

}  // namespace radioslam
