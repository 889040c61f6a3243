#include "radioslam/mission/odometry_edge.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

constexpr double kFloorVarianceXy = 1e-6;   // (1 mm)^2 per edge
constexpr double kFloorVarianceYaw = 1e-8;  // (0.1 mrad)^2 per edge

/// Variance per axis after `distance_m` metres and `turn_rad` radians. The rotation term is linear in the
/// angle, so that a turn split into parts has the variance of the whole.
template <class Pose>
typename Pose::Tangent increment_variance(double distance_m, double turn_rad, const OdometryNoise& noise) {
  const auto square = [](double x) { return x * x; };
  const double xy = square(noise.sigma_xy_per_sqrt_m) * distance_m;
  const double yaw =
      square(noise.sigma_yaw_per_sqrt_m_rad) * distance_m + square(noise.sigma_yaw_per_rad) * turn_rad;
  if constexpr (Pose::kDim == 2) {
    return {xy, xy, yaw};
  } else {
    typename Pose::Tangent variance;
    variance << xy, xy, square(noise.sigma_z_per_sqrt_m) * distance_m, yaw, yaw, yaw;
    return variance;
  }
}

}  // namespace

SE3::Jacobian measured_covariance(const std::vector<OdometryStepNoise>& steps, Stamp begin, Stamp end) {
  SE3::Jacobian covariance = SE3::Jacobian::Zero();
  auto step = std::lower_bound(steps.begin(), steps.end(), begin,
                               [](const OdometryStepNoise& s, Stamp at) { return s.end <= at; });
  for (; step != steps.end() && step->begin < end; ++step)
    covariance +=
        seconds_between(std::max(begin, step->begin), std::min(end, step->end)) * step->covariance_per_s;
  return covariance;
}

template <class Pose>
void append_sample(OdometryEdge<Pose>& edge, const StampedPose<SE3>& from, const StampedPose<SE3>& to,
                   const OdometryNoise& noise) {
  const Pose step = pose_as<Pose>(from.pose).inverse() * pose_as<Pose>(to.pose);
  const typename Pose::Tangent xi = step.log();
  const double distance = step.translation().norm();
  const double turn = xi.template tail<Pose::kDof - Pose::kDim>().norm();
  const typename Pose::Jacobian carry = step.inverse().adjoint();

  edge.covariance = (carry * edge.covariance * carry.transpose()).eval();
  if (noise.steps.empty())
    edge.covariance.diagonal() += increment_variance<Pose>(distance, turn, noise);
  else
    edge.covariance += covariance_as<Pose>(measured_covariance(noise.steps, from.stamp, to.stamp));
  edge.drift_jacobian = (carry * edge.drift_jacobian).eval();
  edge.drift_jacobian(Pose::kDof - 1, 0) += distance;
  edge.drift_jacobian.template topRightCorner<Pose::kDim, 1>() += xi.template head<Pose::kDim>();
  edge.T_i_j = edge.T_i_j * step;
  edge.distance_m += distance;
}

template <class Pose>
OdometryEdge<Pose> followed_by(const OdometryEdge<Pose>& edge, const OdometryEdge<Pose>& next) {
  const typename Pose::Jacobian carry = next.T_i_j.inverse().adjoint();
  return {edge.T_i_j * next.T_i_j, congruence(carry, edge.covariance, next.covariance),
          carry * edge.drift_jacobian + next.drift_jacobian, edge.distance_m + next.distance_m};
}

template <class Pose>
typename Pose::Tangent min_edge_variance() {
  typename Pose::Tangent variance = Pose::Tangent::Constant(kFloorVarianceXy);
  variance.template tail<Pose::kDof - Pose::kDim>().setConstant(kFloorVarianceYaw);
  return variance;
}

template <class Pose>
OdometryEdge<Pose> odometry_edge(const Trajectory<SE3>& odometry, std::size_t begin, std::size_t end,
                                 const OdometryNoise& noise) {
  OdometryEdge<Pose> edge;
  for (std::size_t i = begin; i < end; ++i) append_sample(edge, odometry[i], odometry[i + 1], noise);
  edge.covariance.diagonal() += min_edge_variance<Pose>();
  return edge;
}

std::vector<double> travelled_distance(const Trajectory<SE3>& odometry) {
  std::vector<double> travelled(odometry.size(), 0.0);
  for (std::size_t i = 1; i < odometry.size(); ++i)
    travelled[i] =
        travelled[i - 1] + (odometry[i].pose.translation() - odometry[i - 1].pose.translation()).norm();
  return travelled;
}

double travelled_distance_at(const Trajectory<SE3>& odometry, const std::vector<double>& travelled_m,
                             Stamp stamp) {
  if (odometry.size() < 2 || stamp <= odometry.front().stamp) return 0;
  if (stamp >= odometry.back().stamp) return travelled_m.back();
  const std::size_t i = odometry.segment(stamp);
  const double fraction =
      seconds_between(odometry[i].stamp, stamp) / seconds_between(odometry[i].stamp, odometry[i + 1].stamp);
  return travelled_m[i] + fraction * (travelled_m[i + 1] - travelled_m[i]);
}

#define RADIOSLAM_ODOMETRY_EDGE(Pose)                                                                \
  template OdometryEdge<Pose> odometry_edge(const Trajectory<SE3>&, std::size_t, std::size_t,        \
                                            const OdometryNoise&);                                   \
  template void append_sample(OdometryEdge<Pose>&, const StampedPose<SE3>&, const StampedPose<SE3>&, \
                              const OdometryNoise&);                                                 \
  template OdometryEdge<Pose> followed_by(const OdometryEdge<Pose>&, const OdometryEdge<Pose>&);     \
  template Pose::Tangent min_edge_variance<Pose>();
RADIOSLAM_ODOMETRY_EDGE(SE2)
RADIOSLAM_ODOMETRY_EDGE(SE3)
#undef RADIOSLAM_ODOMETRY_EDGE

}  // namespace radioslam
