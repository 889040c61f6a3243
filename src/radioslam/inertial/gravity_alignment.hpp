// Which way is up, how fast the body goes and how far the gyroscope is off, from the first seconds of an
// odometry that knows nothing of gravity (of laser scans, say) and the inertial readings along it. The
// robot may stand or be under way (Qin & Shen, "Robust Initialization of Monocular Visual-Inertial Estimation
// on Aerial Robots", IROS 2017, without the scale).
//
//   1. gyroscope's bias b:  rotation(b) = R_i^T R_j for every two successive poses; a few steps of
//   Gauss-Newton
//   2. gravity g, accelerometer's bias a, velocities v_k, in the odometry's frame: least squares in
//        R_i^T (p_j - p_i - v_i t - g t^2 / 2) = position(b, a)
//        R_i^T (v_j - v_i - g t)               = velocity(b, a)
//      first with g free, which tells its length, then with the length known
// The accelerometer's bias has its prior: of a robot that stands it cannot be told from a tilt, and
// sigma_tilt_rad says so.
// Refuses where there are too few poses, where readings are missing, and where the length of gravity comes
// out wrong: then poses and readings do not belong together.
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
  int least_poses = 4;
  double sigma_position_m = 0.02;
  double sigma_rotation_rad = 0.005;
  double largest_gravity_error_mps2 = 1;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"window_s", "s", 0.2, 30, "first seconds of the odometry that are looked at"}, self.window_s);
    visit(Field{"least_poses", "", 3, 1000, "in them"}, self.least_poses);
    visit(Field{"sigma_position_m", "m", 1e-6, 10, "error of the odometry's step from pose to pose"},
          self.sigma_position_m);
    visit(Field{"sigma_rotation_rad", "rad", 1e-6, 1, "error of the odometry's rotations"},
          self.sigma_rotation_rad);
    visit(Field{"largest_gravity_error_mps2", "m/s^2", 0.01, 10,
                "of gravity's length, beyond which the alignment is refused"},
          self.largest_gravity_error_mps2);
  }
};

struct GravityAlignment {
  /// Takes vectors of the odometry's frame to one whose z points up: the smallest such rotation.
  Eigen::Quaterniond R_world_odometry = Eigen::Quaterniond::Identity();
  double sigma_tilt_rad = 0;          ///< the larger one of the two directions
  double measured_gravity_mps2 = 0;   ///< its length before it was taken as known
  std::vector<InertialState> states;  ///< at the first poses; the world's origin is the odometry's
};

std::optional<GravityAlignment> align_gravity(const Trajectory<SE3>& odometry,
                                              const std::vector<InertialSample>& samples,
                                              const InertialNoiseParams& noise,
                                              const GravityAlignmentParams& params);

}  // namespace radioslam
