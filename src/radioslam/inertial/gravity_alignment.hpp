// Aligns an odometry with gravity: estimates gravity, velocities and IMU biases over its first seconds.
//
// The odometry (from LiDAR, for example) has metric scale and an arbitrary frame; the robot may move. As Qin
// and Shen, "Robust Initialization of Monocular Visual-Inertial Estimation on Aerial Robots", IROS 2017,
// without the scale:
//   1. gyroscope bias b: rotation(b) = R_i^T R_j for successive poses, by a few Gauss-Newton steps
//   2. gravity g, accelerometer bias a, velocities v_k in the odometry's frame: least squares in
//        R_i^T (p_j - p_i - v_i t - g t^2 / 2) = position(b, a)
//        R_i^T (v_j - v_i - g t)               = velocity(b, a)
//      first with free g, then with its known magnitude
// The accelerometer bias has a prior: for a robot at rest it cannot be distinguished from tilt, which
// sigma_tilt_rad reflects. Refuses if there are too few poses, if IMU samples are missing, and if the
// estimated magnitude of gravity is wrong, a sign that poses and IMU do not belong together.
// Cost: cubic in the poses of the window.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/inertial/preintegration.hpp"

namespace radioslam {

struct GravityAlignmentParams {
  double window_s = 3;
  int min_poses = 4;
  double sigma_position_m = 0.02;
  double sigma_rotation_rad = 0.005;
  double max_gravity_error_mps2 = 1;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(window_s, "s", 0.2, 30,
                    "initial part of the odometry from which gravity is estimated; longer windows are slower "
                    "but more accurate");
    RADIOSLAM_FIELD(min_poses, "", 3, 1000,
                    "smallest number of poses in the window from which gravity is estimated");
    RADIOSLAM_FIELD(sigma_position_m, "m", 1e-6, 10,
                    "standard deviation of the odometry's translation between successive poses");
    RADIOSLAM_FIELD(sigma_rotation_rad, "rad", 1e-6, 1, "standard deviation of the odometry's rotations");
    RADIOSLAM_FIELD(max_gravity_error_mps2, "m/s^2", 0.01, 10,
                    "largest error of gravity's estimated magnitude; alignments beyond it are refused");
  }
};

struct GravityAlignment {
  /// Smallest rotation from the odometry's frame to one whose z points up.
  Eigen::Quaterniond R_world_odometry = Eigen::Quaterniond::Identity();
  double sigma_tilt_rad = 0;          ///< about the less certain of the two horizontal axes
  double measured_gravity_mps2 = 0;   ///< estimated magnitude, before the known one is imposed
  std::vector<InertialState> states;  ///< at the window's poses; the world's origin is the odometry's
};

std::optional<GravityAlignment> align_gravity(const Trajectory<SE3>& odometry,
                                              const std::vector<ImuSample>& samples,
                                              const ImuNoiseParams& noise,
                                              const GravityAlignmentParams& params);

}  // namespace radioslam
