// Dead reckoning of a vehicle that knows which way is down: the plane's part as wheels and a gyroscope give
// it (wheel_odometry.hpp), the height as a random walk, roll and pitch as they are.
#pragma once

#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/sim/wheel_odometry.hpp"

namespace radioslam {

/// Roll and pitch of a pose: what is left of its rotation without the yaw.
Eigen::Quaterniond tilt(const SE3& pose);

/// T_start_body along the true poses, in a level frame at the first position that faces as the body did.
Trajectory<SE3> drift_over_ground(const Trajectory<SE3>& truth, const WheelOdometryParams& params,
                                  double sigma_z_per_sqrt_m, const Rng& rng);

/// What a mission with this odometry states about its noise.
OdometryNoise stated_noise(const WheelOdometryParams& params, double sigma_z_per_sqrt_m);

}  // namespace radioslam
