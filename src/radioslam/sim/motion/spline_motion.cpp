#include "radioslam/sim/motion/spline_motion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "radioslam/base/check.hpp"
#include "radioslam/geometry/so3.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kOrder = 4;

/// Weights of the four controls at u in [0, 1], and their derivatives by u.
struct SplineWeights {
  Eigen::Vector4d value, first, second;
};

SplineWeights weights_at(double u) {
  const double v = 1 - u;
  return {
      Eigen::Vector4d(v * v * v, 3 * u * u * u - 6 * u * u + 4, 3 * v * v * v - 6 * v * v + 4, u * u * u) / 6,
      Eigen::Vector4d(-v * v, 3 * u * u - 4 * u, 4 * v - 3 * v * v, u * u) / 2,
      Eigen::Vector4d(v, 3 * u - 2, 3 * v - 2, u)};
}

}  // namespace

SplineMotion::SplineMotion(std::vector<SE3> controls, double knot_s)
    : controls_(std::move(controls)), knot_s_(knot_s) {
  RADIOSLAM_CHECK(controls_.size() >= kOrder && knot_s > 0, "a cubic spline needs four controls");
  for (std::size_t k = 1; k < controls_.size(); ++k)
    turns_.push_back(so3_log(controls_[k - 1].rotation().conjugate() * controls_[k].rotation()));
}

MotionState SplineMotion::at(Stamp stamp) const {
  const double knots = std::clamp(stamp.seconds(), 0.0, end_s()) / knot_s_;
  const std::size_t first = std::min(static_cast<std::size_t>(knots), controls_.size() - kOrder);
  const SplineWeights weights = weights_at(knots - static_cast<double>(first));

  Eigen::Vector3d position = Eigen::Vector3d::Zero(), velocity = position, acceleration = position;
  for (std::size_t j = 0; j < kOrder; ++j) {
    const Eigen::Vector3d& control = controls_[first + j].translation();
    const auto k = static_cast<Eigen::Index>(j);
    position += weights.value(k) * control;
    velocity += weights.first(k) / knot_s_ * control;
    acceleration += weights.second(k) / (knot_s_ * knot_s_) * control;
  }
  Eigen::Quaterniond rotation = controls_[first].rotation();
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  for (std::size_t j = 1; j < kOrder; ++j) {
    const auto left = static_cast<Eigen::Index>(kOrder - j);
    const Eigen::Vector3d& turn = turns_[first + j - 1];
    const Eigen::Quaterniond step = so3_exp(weights.value.tail(left).sum() * turn);
    rotation = rotation * step;
    rate = step.conjugate() * rate + weights.first.tail(left).sum() / knot_s_ * turn;
  }
  return {SE3(position, rotation), velocity, acceleration, rate};
}

}  // namespace radioslam
