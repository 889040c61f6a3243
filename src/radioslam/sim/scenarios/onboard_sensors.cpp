#include "radioslam/sim/scenarios/onboard_sensors.hpp"

#include <utility>

#include "radioslam/base/check.hpp"
#include "radioslam/base/units.hpp"

namespace radioslam {

RobotMotion make_motion(Trajectory<SE3> trajectory, double rate_hz, const OnboardParams& params,
                        const Rng& rng) {
  if (params.inertial.imu_hz <= 0)
    return {std::make_shared<const TrueMotion>(trajectory), std::move(trajectory)};
  auto motion = std::make_shared<const TrueMotion>(smooth_motion(trajectory, params.ride, rng));
  auto poses = motion->poses(rate_hz);
  return {std::move(motion), std::move(poses)};
}

void add_onboard_sensors(Simulation& simulation,
                         const std::vector<std::shared_ptr<const TrueMotion>>& motions, WorldShapes world,
                         const OnboardParams& params, const Rng& rng) {
  auto& robots = simulation.mission.robots;
  RADIOSLAM_CHECK(motions.size() == robots.size(), "every robot has a motion");
  const auto rays = std::make_shared<const RayWorld>(std::move(world));
  for (std::size_t r = 0; r < robots.size(); ++r) {
    const Rng own = rng.split(r);
    robots[r].lidar = scan_along(rays, motions[r], params.lidar, own.split("lidar"));
    robots[r].inertial = simulate_inertial(*motions[r], params.inertial, own.split("inertial"));
    if (!robots[r].lidar.empty()) robots[r].lidar_view_rad = radians(params.lidar.lidar_view_deg);
    if (params.truth_hz > 0) simulation.truth.robots[r].poses = motions[r]->poses(params.truth_hz);
  }
}

}  // namespace radioslam
