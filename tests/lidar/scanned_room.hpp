// Rooms of boxes and vertical pillars, and exact ray casting of a laser scanner in them.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/lidar/local_map.hpp"
#include "radioslam/lidar/scan_points.hpp"
#include "radioslam/lidar/surfels/voxel_grid.hpp"
#include "radioslam/mission/lidar.hpp"

namespace radioslam::test {

inline constexpr double kDegree = std::numbers::pi / 180;
inline constexpr double kNothing_m = std::numeric_limits<double>::infinity();

/// Axis-aligned: a room seen from inside, a wall or a crate seen from outside.
struct Box {
  Eigen::Vector3d low, high;
};

/// Vertical and of infinite height: seen from outside, or a round hall's wall from inside.
struct Pillar {
  Eigen::Vector2d centre;
  double radius_m = 0.3;
};

struct ScannedRoom {
  std::vector<Box> boxes;
  std::vector<Pillar> pillars;
};

/// Distance along the ray to the surface of the box, from outside or from inside.
inline double distance_to(const Box& box, const Eigen::Vector3d& from, const Eigen::Vector3d& ray) {
  double enters = -kNothing_m, leaves = kNothing_m;
  for (int axis = 0; axis < 3; ++axis) {
    if (ray[axis] == 0 && (from[axis] <= box.low[axis] || from[axis] >= box.high[axis])) return kNothing_m;
    if (ray[axis] == 0) continue;
    const double a = (box.low[axis] - from[axis]) / ray[axis], b = (box.high[axis] - from[axis]) / ray[axis];
    enters = std::max(enters, std::min(a, b));
    leaves = std::min(leaves, std::max(a, b));
  }
  if (enters > leaves || leaves <= 0) return kNothing_m;
  return enters > 0 ? enters : leaves;
}

inline double distance_to(const Pillar& pillar, const Eigen::Vector3d& from, const Eigen::Vector3d& ray) {
  const Eigen::Vector2d offset = from.head<2>() - pillar.centre, along = ray.head<2>();
  const double a = along.squaredNorm(), b = offset.dot(along);
  const double root = b * b - a * (offset.squaredNorm() - pillar.radius_m * pillar.radius_m);
  if (a == 0 || root < 0) return kNothing_m;
  const double enters = (-b - std::sqrt(root)) / a, leaves = (-b + std::sqrt(root)) / a;
  if (leaves <= 0) return kNothing_m;
  return enters > 0 ? enters : leaves;
}

inline double distance_to(const ScannedRoom& room, const Eigen::Vector3d& from, const Eigen::Vector3d& ray) {
  double nearest = kNothing_m;
  for (const Box& box : room.boxes) nearest = std::min(nearest, distance_to(box, from, ray));
  for (const Pillar& pillar : room.pillars) nearest = std::min(nearest, distance_to(pillar, from, ray));
  return nearest;
}

/// Stacked beams, swept around the vertical axis; points beyond `max_m` are not in the scan.
struct Scanner {
  int beams = 16, azimuths = 360;
  double lowest_rad = -15 * kDegree, highest_rad = 15 * kDegree;
  double view_rad = 2 * std::numbers::pi;  ///< about body x
  double sigma_range_m = 0.02;
  double max_m = 100;
  double sweep_s = 0;   ///< > 0: points have times
  double stamp_at = 0;  ///< fraction of the sweep before the stamp
};

inline Scanner planar_scanner(int azimuths = 360, double view_rad = 2 * std::numbers::pi) {
  Scanner scanner;
  scanner.beams = 1;
  scanner.azimuths = azimuths;
  scanner.lowest_rad = 0;
  scanner.view_rad = view_rad;
  return scanner;
}

/// A scan by a robot that is at `T_room_body` at the stamp and moves with this twist.
inline LidarScan sweep(const ScannedRoom& room, const Scanner& scanner, const SE3& T_room_body, Rng& rng,
                       const SE3::Tangent& twist_per_s = SE3::Tangent::Zero()) {
  LidarScan scan;
  for (int a = 0; a < scanner.azimuths; ++a) {
    const double fraction = a / static_cast<double>(scanner.azimuths);
    const double time_s = scanner.sweep_s * (fraction - scanner.stamp_at),
                 azimuth = (fraction - 0.5) * scanner.view_rad;
    const SE3 T = T_room_body * SE3::exp(time_s * twist_per_s);
    for (int b = 0; b < scanner.beams; ++b) {
      const double rise = b / std::max(1.0, scanner.beams - 1.0);
      const double elevation = scanner.lowest_rad + rise * (scanner.highest_rad - scanner.lowest_rad);
      const double level = scanner.beams == 1 ? 0 : elevation;
      const Eigen::Vector3d ray(std::cos(level) * std::cos(azimuth), std::cos(level) * std::sin(azimuth),
                                std::sin(level));
      const double range = distance_to(room, T.translation(), T.rotate(ray));
      if (range > scanner.max_m) continue;
      const double noise = rng.normal(0, scanner.sigma_range_m);
      scan.points.emplace_back(((range + noise) * ray).cast<float>());
      if (scanner.sweep_s > 0) scan.times_s.push_back(static_cast<float>(time_s));
    }
  }
  return scan;
}

/// A scan's surfels as computed by the odometry.
inline std::vector<Surfel> surfels_of(const LidarScan& scan, double spacing_m, ScannerKind kind) {
  const auto points = filter_and_deskew(scan, SE3::Tangent::Zero(), {}).points;
  return measure_surfels(voxel_downsample(points, spacing_m), spacing_m, kind, {});
}

inline ScanPyramid pyramid_of(const LidarScan& scan, double spacing_m, ScannerKind kind) {
  return scan_pyramid(surfels_of(scan, spacing_m, kind), spacing_m, kind, {});
}

/// A room without self-similar views.
inline ScannedRoom furnished_room() {
  ScannedRoom room;
  room.boxes = {{{-6, -4, 0}, {6, 4, 3}},        // the room itself
                {{2, 1.5, 0}, {3.5, 2.5, 1.6}},  // crates
                {{-4.5, -3, 0}, {-3, -2.2, 2}},
                {{-6, 2, 0}, {-4.6, 4, 3}},       // a closet in a corner
                {{3.5, -4, 0}, {4.1, -2.4, 3}}};  // the stub of a wall
  room.pillars = {{{0.5, -2}, 0.25}, {{-1.8, 2.4}, 0.2}};
  return room;
}

/// Tangent with this translation in the plane and this rotation about z.
inline SE3::Tangent planar_motion(double x_m, double y_m, double yaw_rad) {
  SE3::Tangent xi = SE3::Tangent::Zero();
  xi[0] = x_m;
  xi[1] = y_m;
  xi[5] = yaw_rad;
  return xi;
}

inline SE3 pose_at(double x_m, double y_m, double z_m, double yaw_rad) {
  return lift(SE2({x_m, y_m}, yaw_rad), z_m);
}

inline double distance_between(const SE3& a, const SE3& b) {
  return (a.translation() - b.translation()).norm();
}
inline double angle_between(const SE3& a, const SE3& b) { return (a.inverse() * b).log().tail<3>().norm(); }

}  // namespace radioslam::test
