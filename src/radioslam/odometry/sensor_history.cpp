#include "radioslam/odometry/sensor_history.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "radioslam/base/statistics.hpp"

namespace radioslam {
namespace {

constexpr double kNoGap = 2;                    // nominal intervals
constexpr std::ptrdiff_t kMaxForgotten = 1024;  // steps that are kept though nothing needs them

}  // namespace

void NominalInterval::add(Stamp stamp) {
  if (last_) {
    intervals_s_.push_back(seconds_between(*last_, stamp));
    if (intervals_s_.size() > kLast) intervals_s_.pop_front();
    median_s_ = upper_median(std::vector<double>(intervals_s_.begin(), intervals_s_.end()));
  }
  last_ = stamp;
}

SensorHistory::SensorHistory(Robot robot) : robot_(std::move(robot)) {
  robot_.odometry = {};
  robot_.inertial.clear();
  robot_.lidar = {};
}

void SensorHistory::add(const StampedPose<SE3>& odometry) {
  if (!rows_.empty()) {
    const double duration_s = seconds_between(rows_.back().stamp, odometry.stamp);
    if (duration_s <= kNoGap * sample_interval_s()) {
      const SE3::Tangent step = (rows_.back().pose.inverse() * odometry.pose).log();
      fastest_mps_ = std::max(fastest_mps_, step.head<3>().norm() / duration_s);
      fastest_radps_ = std::max(fastest_radps_, step.tail<3>().norm() / duration_s);
    }
  }
  rows_.push_back(odometry);
  sample_interval_.add(odometry.stamp);
}

bool SensorHistory::has_been_as_fast(const SE3& motion, double duration_s) const {
  const SE3::Tangent step = motion.log();
  return step.head<3>().norm() <= duration_s * fastest_mps_ &&
         step.tail<3>().norm() <= duration_s * fastest_radps_;
}

void SensorHistory::update() {
  if (robot_.odometry.size() == rows_.size() &&
      (rows_.empty() || robot_.odometry.back().stamp == rows_.back().stamp))
    return;
  robot_.odometry = Trajectory<SE3>(std::vector<StampedPose<SE3>>(rows_.begin(), rows_.end()));
}

void SensorHistory::forget_before(Stamp stamp) {
  while (rows_.size() > 1 && rows_[1].stamp <= stamp) rows_.pop_front();
  auto& steps = robot_.odometry_noise.steps;
  if (std::ssize(steps) > kMaxForgotten && steps[static_cast<std::size_t>(kMaxForgotten)].end <= stamp)
    steps.erase(steps.begin(), steps.begin() + kMaxForgotten);
}

}  // namespace radioslam
