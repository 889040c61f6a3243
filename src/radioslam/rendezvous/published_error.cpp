#include "radioslam/rendezvous/published_error.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace radioslam {

namespace {

/// Of poses that are near each other.
class MeanPose {
 public:
  void add(const SE2& pose) {
    sum_ += Eigen::Vector3d(pose.translation().x(), pose.translation().y(), pose.angle());
    ++count_;
  }
  SE2 pose() const {
    const Eigen::Vector3d mean = sum_ / count_;
    return {mean.head<2>(), mean.z()};
  }

 private:
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  int count_ = 0;
};

}  // namespace

PublishedError::PublishedError(double omega_t, double omega_r, std::uint64_t seed, const SE2& start)
    : omega_t_(omega_t), omega_r_(omega_r), rng_(seed), raw_{start} {}

double PublishedError::term(const SE2& T_i, const SE2& T_j, const SE2& T_i_j) const {
  const SE2 predicted = T_i * T_i_j;
  const double offset_m = (T_j.translation() - predicted.translation()).norm();
  // |R_a - R_b|_F^2 = 4 (1 - cos(a - b)) in the plane.
  const double turn = 4 * (1 - std::cos(T_j.angle() - predicted.angle()));
  return omega_t_ * omega_t_ * offset_m * offset_m + omega_r_ * omega_r_ / 2 * turn;
}

void PublishedError::move(const SE2& measured, double sigma_m, double sigma_rad) {
  // The noise of the raw pose and that of the measurement, both in the raw step.
  const double m = std::numbers::sqrt2 * sigma_m, rad = std::numbers::sqrt2 * sigma_rad;
  const double x = rng_.normal(0, m), y = rng_.normal(0, m), turn = rng_.normal(0, rad);
  const SE2 before = raw_.back();
  raw_.push_back(before * SE2(measured.translation() + Eigen::Vector2d(x, y), measured.angle() + turn));
  since_ += term(before, raw_.back(), measured);
}

void PublishedError::see(const SE2& T_i_j, const std::optional<SE2>& raw_other) {
  if (raw_other) since_ += term(raw_.back(), *raw_other, T_i_j);
}

void PublishedError::optimized(const RobotEstimate& team) {
  raw_ = team.poses();
  since_ = settled_ = 0;
  for (std::size_t k = 1; k < raw_.size(); ++k)
    settled_ += term(raw_[k - 1], raw_[k], team.own().steps()[k].pose);
  std::map<std::pair<std::uint32_t, std::string>, MeanPose> means;
  for (const Sighting& seen : team.own().sightings())
    if (const auto other = team.pose_of(seen.robot, seen.stamp))
      means[{seen.keyframe, seen.robot}].add(other->inverse() * raw_[seen.keyframe] * seen.T_i_j);
  for (const auto& [key, mean] : means) settled_ += term(SE2(), mean.pose(), SE2());
}

}  // namespace radioslam
