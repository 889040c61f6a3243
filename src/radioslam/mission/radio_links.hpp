// Radio measurements between robots and anchors, matches from external place recognition, and position fixes.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/base/strong_id.hpp"
#include "radioslam/geometry/se3.hpp"

namespace radioslam {

/// Index into Mission::anchors.
using AnchorIndex = StrongId<struct AnchorTag>;

/// Static radio at a known or unknown position.
struct Anchor {
  std::string id;
  std::optional<Eigen::Vector3d> position_m;  ///< in the common frame; absent when unknown
  double sigma_m = 0;                         ///< of a known position, per axis
};

/// One end of a measurement: a robot's radio or an anchor.
struct LinkEnd {
  RobotIndex robot{};
  AnchorIndex anchor{};                                   ///< used when `robot` is invalid
  std::string antenna;                                    ///< name; empty if the robot has only one
  Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();  ///< antenna position in the robot's body frame
};

/// Distance between two ends at one time; at least one of them is a robot.
struct RangeMeasurement {
  Stamp stamp;
  LinkEnd i, j;
  double range_m = 0;
  double sigma_m = 1;
};

/// Direction of arrival of one path, in the receiver's body frame.
struct AoaPath {
  double azimuth_rad = 0;               ///< counter-clockwise from body x
  std::optional<double> elevation_rad;  ///< up from the body's xy-plane; absent when not measured
  double sigma_rad = 1;
  double power_db = 0;
};

/// Angles of arrival of one transmission, at most one of which is the direct path.
struct AoaMeasurement {
  Stamp stamp;
  RobotIndex receiver;
  LinkEnd transmitter;
  std::vector<AoaPath> paths;  ///< at least one
};

/// Relative pose T_i_j of robot j at t_j as seen from robot i at t_i (the same robot for intra-robot
/// matches).
struct PoseMatch {
  RobotIndex robot_i, robot_j;
  Stamp stamp_i, stamp_j;
  SE3 T_i_j;
  SE3::Jacobian covariance = SE3::Jacobian::Identity();  ///< of xi in T_i_j Exp(xi); m^2, rad^2
};

/// Covariance with the same standard deviation along every axis, and about every axis.
inline SE3::Jacobian isotropic_covariance(double sigma_t_m, double sigma_r_rad) {
  SE3::Tangent variance = SE3::Tangent::Constant(sigma_t_m * sigma_t_m);
  variance.tail<3>().setConstant(sigma_r_rad * sigma_r_rad);
  return variance.asDiagonal();
}

/// Position of a robot, or of its receiver's antenna, in the common frame.
struct PositionFix {
  Stamp stamp;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  double sigma_m = 1;
};

}  // namespace radioslam
