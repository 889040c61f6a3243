// What robots measured of each other by radio, and matches that someone else's place recognition found.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/base/strong_id.hpp"
#include "radioslam/geometry/se3.hpp"

namespace radioslam {

/// An anchor's place in Mission::anchors.
using AnchorIndex = StrongId<struct AnchorTag>;

/// A static radio.
struct Anchor {
  std::string id;
  std::optional<Eigen::Vector3d> position_m;  ///< in the common frame; absent when unknown
  double sigma_m = 0;                         ///< of a known position, per axis
};

/// One end of a measurement: a robot's radio or an anchor.
struct RadioEnd {
  RobotIndex robot{};
  AnchorIndex anchor{};                                   ///< used when `robot` is invalid
  std::string antenna;                                    ///< its name; empty where the robot has one only
  Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();  ///< the antenna in the robot's body frame
};

/// The distance between two ends at one time. At least one is a robot.
struct RangeMeasurement {
  Stamp stamp;
  RadioEnd i, j;
  double range_m = 0;
  double sigma_m = 1;
};

/// A direction from which a packet arrived, in the receiver's body frame.
struct ArrivalPath {
  double azimuth_rad = 0;               ///< counter-clockwise from body x
  std::optional<double> elevation_rad;  ///< up from the body's xy-plane; absent when not measured
  double sigma_rad = 1;
  double power_db = 0;
};

/// The paths by which one transmitter was heard, of which at most one is direct.
struct ArrivalMeasurement {
  Stamp stamp;
  RobotIndex receiver;
  RadioEnd transmitter;
  std::vector<ArrivalPath> paths;  ///< at least one
};

/// Robot i at t_i saw robot j at t_j (or itself, at another time) in the relative pose T_i_j.
struct PoseMatch {
  RobotIndex robot_i, robot_j;
  Stamp stamp_i, stamp_j;
  SE3 T_i_j;
  double sigma_t_m = 1;
  double sigma_r_rad = 1;
};

/// Where a robot, or the antenna of its receiver, was in the common frame.
struct PositionFix {
  Stamp stamp;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  double sigma_m = 1;
};

}  // namespace radioslam
