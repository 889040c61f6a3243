#include "radioslam/graph/pose_chart.hpp"

#include "radioslam/geometry/so3.hpp"

namespace radioslam {

SE2::Tangent chart_error(PoseChart chart, const SE2& error) {
  if (chart == PoseChart::kLogarithm) return error.log();
  return {error.translation().x(), error.translation().y(), error.angle()};
}

SE3::Tangent chart_error(PoseChart chart, const SE3& error) {
  if (chart == PoseChart::kLogarithm) return error.log();
  const double sign = error.rotation().w() < 0 ? -1 : 1;
  SE3::Tangent e;
  e << error.translation(), sign * error.rotation().vec();
  return e;
}

SE2::Jacobian chart_derivative(PoseChart chart, const SE2& error) {
  if (chart == PoseChart::kLogarithm) return SE2::right_jacobian_inverse(error.log());
  SE2::Jacobian j = SE2::Jacobian::Identity();
  j.topLeftCorner<2, 2>() = error.rotation_matrix();
  return j;
}

SE3::Jacobian chart_derivative(PoseChart chart, const SE3& error) {
  if (chart == PoseChart::kLogarithm) return SE3::right_jacobian_inverse(error.log());
  // vec(q * [1, phi / 2]) = v + (w phi + v x phi) / 2.
  const double half_sign = error.rotation().w() < 0 ? -0.5 : 0.5;
  SE3::Jacobian j = SE3::Jacobian::Zero();
  j.topLeftCorner<3, 3>() = error.rotation_matrix();
  j.bottomRightCorner<3, 3>() = skew(half_sign * error.rotation().vec());
  j.diagonal().tail<3>().array() += half_sign * error.rotation().w();
  return j;
}

}  // namespace radioslam
