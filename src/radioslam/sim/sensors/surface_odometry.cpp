#include "radioslam/sim/sensors/surface_odometry.hpp"

#include <cmath>
#include <utility>

#include "radioslam/geometry/so3.hpp"

namespace radioslam {

Eigen::Quaterniond tilt(const SE3& pose) { return so3_exp({0, 0, -pose.yaw()}) * pose.rotation(); }

Trajectory<SE3> drift_over_ground(const Trajectory<SE3>& truth, const WheelOdometryParams& params,
                                  double sigma_z_per_sqrt_m, const Rng& rng) {
  std::vector<SE2> from_above;
  for (const auto& [stamp, pose] : truth) from_above.push_back(flatten(pose));
  const auto planar = draw_dead_reckoning(from_above, params, rng.split("plane")).T_start_body;
  Rng height = rng.split("height");
  std::vector<StampedPose<SE3>> poses;
  double z_m = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (i > 0) {
      const Eigen::Vector3d step = truth[i].pose.translation() - truth[i - 1].pose.translation();
      z_m += step.z() + height.normal(0, sigma_z_per_sqrt_m * std::sqrt(step.norm()));
    }
    const SE3 level = lift(planar[i], z_m);
    poses.push_back({truth[i].stamp, {level.translation(), level.rotation() * tilt(truth[i].pose)}});
  }
  return Trajectory<SE3>(std::move(poses));
}

OdometryNoise stated_noise(const WheelOdometryParams& params, double sigma_z_per_sqrt_m) {
  OdometryNoise noise = stated_noise(params);
  noise.sigma_z_per_sqrt_m = params.stated_noise_factor * sigma_z_per_sqrt_m;
  return noise;
}

}  // namespace radioslam
