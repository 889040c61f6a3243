// Dead reckoning of a ground vehicle with known gravity: planar motion from wheels and a gyroscope
// (wheel_odometry.hpp), height as a random walk, roll and pitch without error.
#pragma once

#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/sim/sensors/wheel_odometry.hpp"

namespace radioslam {

/// Roll and pitch of a pose: its rotation without the yaw.
Eigen::Quaterniond tilt(const SE3& pose);

/// T_start_body along the true poses, in a level frame at the first position with the body's initial heading.
Trajectory<SE3> drift_over_ground(const Trajectory<SE3>& truth, const WheelOdometryParams& params,
                                  double sigma_z_per_sqrt_m, const Rng& rng);

/// Odometry noise as a mission states it.
OdometryNoise stated_noise(const WheelOdometryParams& params, double sigma_z_per_sqrt_m);

}  // namespace radioslam
