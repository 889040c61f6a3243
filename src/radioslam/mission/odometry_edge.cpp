#include "radioslam/mission/odometry_edge.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "radioslam/base/check.hpp"
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
  if (const SE3::Jacobian measured = measured_covariance(noise.steps, from.stamp, to.stamp);
      measured.isZero(0))
    edge.covariance.diagonal() += increment_variance<Pose>(distance, turn, noise);
  else
    edge.covariance += covariance_as<Pose>(measured);
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

template <class Pose>
UncertainPose<Pose> with_drift(const OdometryEdge<Pose>& edge, const OdometryNoise& noise) {
  const Eigen::Vector2d variance(noise.sigma_yaw_drift_per_m_rad * noise.sigma_yaw_drift_per_m_rad,
                                 noise.sigma_scale * noise.sigma_scale);
  return {edge.T_i_j,
          edge.covariance + edge.drift_jacobian * variance.asDiagonal() * edge.drift_jacobian.transpose()};
}

#define RADIOSLAM_ODOMETRY_EDGE(Pose)                                                                \
  template OdometryEdge<Pose> odometry_edge(const Trajectory<SE3>&, std::size_t, std::size_t,        \
                                            const OdometryNoise&);                                   \
  template void append_sample(OdometryEdge<Pose>&, const StampedPose<SE3>&, const StampedPose<SE3>&, \
                              const OdometryNoise&);                                                 \
  template OdometryEdge<Pose> followed_by(const OdometryEdge<Pose>&, const OdometryEdge<Pose>&);     \
  template UncertainPose<Pose> with_drift(const OdometryEdge<Pose>&, const OdometryNoise&);          \
  template Pose::Tangent min_edge_variance<Pose>();
RADIOSLAM_ODOMETRY_EDGE(SE2)
RADIOSLAM_ODOMETRY_EDGE(SE3)
#undef RADIOSLAM_ODOMETRY_EDGE

namespace {

/// Edge between two ordered times; the poses at both ends are interpolated.
template <class Pose>
OdometryEdge<Pose> edge_between(const Robot& robot, Stamp from, Stamp to) {
  const Trajectory<SE3>& odometry = robot.odometry;
  RADIOSLAM_CHECK(odometry.covers(from) && odometry.covers(to), "odometry must cover both stamps");
  std::vector<StampedPose<SE3>> rows{{from, *odometry.at(from)}};
  const auto first_after = std::upper_bound(odometry.begin(), odometry.end(), from,
                                            [](Stamp s, const auto& row) { return s < row.stamp; });
  for (auto row = first_after; row != odometry.end() && row->stamp < to; ++row) rows.push_back(*row);
  if (from < to) rows.push_back({to, *odometry.at(to)});
  const std::size_t last = rows.size() - 1;
  return odometry_edge<Pose>(Trajectory<SE3>(std::move(rows)), 0, last, robot.odometry_noise);
}

}  // namespace

template <class Pose>
UncertainPose<Pose> odometry_between(const Robot& robot, Stamp from, Stamp to) {
  const auto forward =
      with_drift(edge_between<Pose>(robot, std::min(from, to), std::max(from, to)), robot.odometry_noise);
  return from <= to ? forward : forward.inverse();
}

template <class Pose>
std::vector<UncertainPose<Pose>> odometry_since_start(const Robot& robot, const std::vector<Stamp>& stamps) {
  RADIOSLAM_CHECK(std::is_sorted(stamps.begin(), stamps.end()), "stamps must not decrease");
  OdometryEdge<Pose> sum;
  sum.T_i_j = pose_as<Pose>(robot.odometry.front().pose);
  Stamp reached = robot.odometry.front().stamp;
  std::vector<UncertainPose<Pose>> poses;
  for (const Stamp stamp : stamps) {
    if (reached < stamp) sum = followed_by(sum, edge_between<Pose>(robot, reached, stamp));
    reached = stamp;
    poses.push_back(with_drift(sum, robot.odometry_noise));
  }
  return poses;
}

#define RADIOSLAM_ODOMETRY_BETWEEN(Pose)                                     \
  template UncertainPose<Pose> odometry_between(const Robot&, Stamp, Stamp); \
  template std::vector<UncertainPose<Pose>> odometry_since_start(const Robot&, const std::vector<Stamp>&);
RADIOSLAM_ODOMETRY_BETWEEN(SE2)
RADIOSLAM_ODOMETRY_BETWEEN(SE3)
#undef RADIOSLAM_ODOMETRY_BETWEEN

}  // namespace radioslam
