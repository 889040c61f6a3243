#include "radioslam/joint/aoa/aoa_predictions.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/joint/links/radio_factors.hpp"

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

}  // namespace radioslam
