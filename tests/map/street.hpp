// A street between houses, with posts and a hedge, in which boxes move; robots scan it while they drive. All
// poses are known.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/lidar/lidar_params.hpp"
#include "radioslam/map/placed_scan.hpp"
#include "radioslam/sim/worlds/ray_world.hpp"

namespace radioslam::street {

/// A box that passes (x, y) at time 0 with this speed along x.
struct MovingBox {
  double x = 0, y = 0, speed_mps = 0;
  Eigen::Vector2d half_size_m{2, 0.9};
  double top_m = 1.5;

  UprightBox at(double t_s) const {
    return {{x + speed_mps * t_s, y}, Eigen::Vector2d::UnitX(), half_size_m, 0, top_m};
  }
};

struct Street {
  double length_m = 80, duration_s = 50, rate_hz = 5, range_m = 40, sigma_m = 0.02;
  int steps = 450, beams = 16;
  std::vector<UprightBox> houses;
  std::vector<UprightPillar> posts;
  std::vector<MovingBox> moving;

  Street() {
    for (double x = -20; x < length_m + 20; x += 12)
      for (const double y : {-8.0, 8.0})
        houses.push_back({{x + 5, y + (y > 0 ? 3.0 : -3.0)}, Eigen::Vector2d::UnitX(), {4.5, 3}, 0, 6});
    houses.push_back({{40, 6}, Eigen::Vector2d::UnitX(), {8, 0.2}, 0, 0.6});  // a hedge
    for (double x = 0; x < length_m; x += 15) posts.push_back({{x, -6}, 0.1, 0, 4});
  }

  void add_traffic() {
    for (int k = 0; k < 8; ++k) moving.push_back({-60.0 * k - 10, 2.0, 6.0});
    for (int k = 0; k < 8; ++k) moving.push_back({60.0 * k + 90, -3.5, -5.0});
    for (int k = 0; k < 5; ++k) moving.push_back({14.0 * k, 4.3, k % 2 == 0 ? 1.4 : -1.2, {0.3, 0.25}, 1.7});
  }

  WorldShapes shapes() const {
    WorldShapes shapes;
    shapes.boxes = houses;
    shapes.pillars = posts;
    return shapes;
  }

  /// Whether a point is nearer than `tolerance_m` to something that stands still.
  bool is_static(const Eigen::Vector3d& at, double tolerance_m) const {
    const auto is_near = [&](const auto& shape) {
      return at.z() < shape.top_m + tolerance_m && floor_distance_m(shape, at.head<2>()) < tolerance_m;
    };
    return at.z() < 0.05 || std::any_of(houses.begin(), houses.end(), is_near) ||
           std::any_of(posts.begin(), posts.end(), is_near);
  }
};

constexpr double kScanner_m = 0.7;

/// One turn of the scanner from `t_s` on, in the body frame at each point's time.
inline LidarScan sweep(const Street& street, const RayWorld& world, const Trajectory<SE3>& poses, double t_s,
                       Rng rng) {
  LidarScan scan;
  for (int step = 0; step < street.steps; ++step) {
    const double part = (step + 0.5) / street.steps, azimuth = 2 * std::numbers::pi * (part - 0.5);
    const double time_s = part / street.rate_hz;
    const SE3 T = *poses.at(Stamp::from_seconds(std::min(t_s + time_s, street.duration_s)));
    for (int beam = 0; beam < street.beams; ++beam) {
      const double elevation = (-15 + 30.0 * beam / (street.beams - 1)) * std::numbers::pi / 180;
      const Eigen::Vector3d along(std::cos(elevation) * std::cos(azimuth),
                                  std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const Ray ray{T * Eigen::Vector3d(0, 0, kScanner_m), T.rotate(along)};
      auto hit = world.cast(ray, street.range_m);
      for (const MovingBox& box : street.moving)
        if (const auto moving = ray_hit(ray, box.at(t_s + time_s));
            moving && (!hit || moving->range_m < hit->range_m))
          hit = moving;
      if (!hit || hit->range_m > street.range_m) continue;
      const double range_m = hit->range_m + rng.normal(0, street.sigma_m);
      scan.points.push_back((Eigen::Vector3d(0, 0, kScanner_m) + range_m * along).cast<float>());
      scan.times_s.push_back(static_cast<float>(time_s));
    }
  }
  return scan;
}

/// Robots that drive along the street, one behind another, at true poses.
inline std::vector<MappedRobot> robots(const Street& street, int count, double speed_mps = 1.2) {
  auto world = std::make_shared<const RayWorld>(street.shapes());
  std::vector<MappedRobot> robots;
  for (int r = 0; r < count; ++r) {
    std::vector<StampedPose<SE3>> rows;
    for (int k = 0; k <= static_cast<int>(10 * street.duration_s); ++k) {
      const double t_s = 0.1 * k, x = 10.0 * r + speed_mps * t_s;
      rows.push_back(
          {Stamp::from_seconds(t_s), lift(SE2({x, -1 + 0.5 * std::sin(0.2 * x)}, 0.1 * std::cos(0.2 * x)))});
    }
    const Trajectory<SE3> poses(std::move(rows));
    LidarLog log;
    for (int k = 0; k < static_cast<int>(street.rate_hz * street.duration_s) - 1; ++k)
      log.stamps.push_back(Stamp::from_seconds(k / street.rate_hz));
    log.read = [street, world, poses, r, stamps = log.stamps](std::size_t k) {
      return sweep(street, *world, poses, stamps[k].seconds(),
                   Rng(7).split(static_cast<std::uint64_t>(r)).split(k));
    };
    robots.push_back(
        mapped_robot(std::string(1, static_cast<char>('a' + r)), std::move(log), poses, LidarParams{}));
  }
  return robots;
}

}  // namespace radioslam::street
