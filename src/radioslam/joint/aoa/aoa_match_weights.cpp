#include "radioslam/joint/aoa/aoa_match_weights.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/base/statistics.hpp"
#include "radioslam/joint/links/radio_factors.hpp"
#include "radioslam/mission/odometry_edge.hpp"

namespace radioslam {
namespace {

constexpr double kNoDistance_m = 1e-9;

double sigma_along(const Eigen::Matrix3d& covariance, const Eigen::Vector3d& gradient) {
  return std::sqrt(std::max(0.0, gradient.dot(covariance * gradient)));
}

}  // namespace

template <class Pose>
DirectionSigma direction_sigma(const UncertainPose<Pose>& T_i_j) {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  p.head<Pose::kDim>() = T_i_j.pose.translation();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  covariance.topLeftCorner<Pose::kDim, Pose::kDim>() = T_i_j.position_covariance();
  const double level_m = std::max(p.head<2>().norm(), kNoDistance_m);
  const Eigen::Vector3d azimuth = Eigen::Vector3d(-p.y(), p.x(), 0) / (level_m * level_m);
  const double square = std::max(p.squaredNorm(), kNoDistance_m * kNoDistance_m);
  const Eigen::Vector3d elevation =
      Eigen::Vector3d(-p.x() * p.z() / level_m, -p.y() * p.z() / level_m, level_m) / square;
  return {sigma_along(covariance, azimuth), sigma_along(covariance, elevation)};
}

template <class Pose>
AoaAgreement check_angles(const UncertainPose<Pose>& T_receiver_transmitter, const AoaMeasurement& measured,
                          const Mission& mission, const AoaLikelihoodParams& params) {
  const SE3 T_start_receiver = *mission.robots[measured.receiver.index()].odometry.at(measured.stamp);
  return check_relative_pose(as_se3(T_receiver_transmitter.pose, 0),
                             as_estimated<Pose>(measured, T_start_receiver), params,
                             direction_sigma(T_receiver_transmitter));
}

bool is_between_robots(const AoaMeasurement& measured, const Mission& mission) {
  const auto covered = [&](RobotIndex robot) {
    return robot.valid() && mission.robots[robot.index()].odometry.covers(measured.stamp);
  };
  return covered(measured.receiver) && covered(measured.transmitter.robot);
}

#define RADIOSLAM_ANGLE_PREDICTIONS(Pose)                                                               \
  template DirectionSigma direction_sigma(const UncertainPose<Pose>&);                                  \
  template AoaAgreement check_angles(const UncertainPose<Pose>&, const AoaMeasurement&, const Mission&, \
                                     const AoaLikelihoodParams&);
RADIOSLAM_ANGLE_PREDICTIONS(SE2)
RADIOSLAM_ANGLE_PREDICTIONS(SE3)
#undef RADIOSLAM_ANGLE_PREDICTIONS

namespace {

std::pair<RobotIndex, RobotIndex> ordered(RobotIndex a, RobotIndex b) { return std::minmax(a, b); }

template <class Pose>
UncertainPose<Pose> uncertain(const Closure& match) {
  return {pose_as<Pose>(match.T_i_j), covariance_of<Pose>(match)};
}

}  // namespace

AoaMatchWeights::AoaMatchWeights(const Mission& mission, const MatchParams& params,
                                 const AoaLikelihoodParams& likelihood)
    : mission_(mission), params_(params), likelihood_(likelihood) {
  for (const Robot& robot : mission.robots) travelled_m_.push_back(travelled_distance(robot.odometry));
  for (std::size_t a = 0; a < mission.aoa_measurements.size(); ++a) {
    const AoaMeasurement& aoa = mission.aoa_measurements[a];
    if (is_between_robots(aoa, mission))
      aoa_measurements_[ordered(aoa.receiver, aoa.transmitter.robot)].push_back(a);
  }
}

std::vector<std::size_t> AoaMatchWeights::nearest(const Closure& match) const {
  const auto between = aoa_measurements_.find(ordered(match.robot_i, match.robot_j));
  if (between == aoa_measurements_.end()) return {};
  const auto travelled_m = [&](RobotIndex robot, Stamp stamp) {
    return travelled_distance_at(mission_.robots[robot.index()].odometry, travelled_m_[robot.index()], stamp);
  };
  const double at_i = travelled_m(match.robot_i, match.stamp_i),
               at_j = travelled_m(match.robot_j, match.stamp_j);
  std::vector<std::pair<double, std::size_t>> by_distance;
  for (const std::size_t a : between->second) {
    const Stamp stamp = mission_.aoa_measurements[a].stamp;
    const double path_m = std::abs(travelled_m(match.robot_i, stamp) - at_i) +
                          std::abs(travelled_m(match.robot_j, stamp) - at_j);
    if (path_m <= params_.max_carried_m) by_distance.emplace_back(path_m, a);
  }
  std::sort(by_distance.begin(), by_distance.end());
  std::vector<std::size_t> aoa_measurements;
  for (const auto& [path_m, a] : by_distance)
    if (aoa_measurements.size() < static_cast<std::size_t>(params_.angles)) aoa_measurements.push_back(a);
  return aoa_measurements;
}

template <class Pose>
std::optional<double> AoaMatchWeights::information_scale(const Closure& match) const {
  const Robot& robot_i = mission_.robots[match.robot_i.index()];
  const Robot& robot_j = mission_.robots[match.robot_j.index()];
  std::vector<double> scales;
  for (const std::size_t a : nearest(match)) {
    const AoaMeasurement& aoa = mission_.aoa_measurements[a];
    const UncertainPose<Pose> T_i_j = odometry_between<Pose>(robot_i, aoa.stamp, match.stamp_i) *
                                      uncertain<Pose>(match) *
                                      odometry_between<Pose>(robot_j, match.stamp_j, aoa.stamp);
    const bool i_receives = aoa.receiver == match.robot_i;
    scales.push_back(
        check_angles(i_receives ? T_i_j : T_i_j.inverse(), aoa, mission_, likelihood_).information_scale());
  }
  if (scales.empty()) return std::nullopt;
  return lower_median(std::move(scales));
}

template std::optional<double> AoaMatchWeights::information_scale<SE2>(const Closure&) const;
template std::optional<double> AoaMatchWeights::information_scale<SE3>(const Closure&) const;

}  // namespace radioslam
