#include "radioslam/mission/odometry_between.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/base/check.hpp"

namespace radioslam {
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

template <class Pose>
UncertainPose<Pose> with_drift(const OdometryEdge<Pose>& edge, const OdometryNoise& noise) {
  const Eigen::Vector2d variance(noise.sigma_yaw_drift_per_m_rad * noise.sigma_yaw_drift_per_m_rad,
                                 noise.sigma_scale * noise.sigma_scale);
  return {edge.T_i_j,
          edge.covariance + edge.drift_jacobian * variance.asDiagonal() * edge.drift_jacobian.transpose()};
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
