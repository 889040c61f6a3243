// Simulated drives of a laser scanner through rooms.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "lidar/scanned_room.hpp"
#include "radioslam/lidar/lidar_odometry.hpp"

namespace radioslam::test {

/// Scans with the true poses at their stamps.
struct ScanDrive {
  std::vector<Stamp> stamps;
  std::vector<SE3> truth;  ///< T_room_body
  std::vector<LidarScan> scans;

  /// True pose in the frame of the first scan, which odometry should reproduce.
  SE3 way_to(std::size_t k) const { return truth.front().inverse() * truth[k]; }
  SE3 way() const { return way_to(truth.size() - 1); }
};

/// Ten scans per second along these poses, each swept while passing its pose.
inline ScanDrive drive_along(const ScannedRoom& room, const Scanner& scanner, const std::vector<SE3>& poses,
                             std::uint64_t seed) {
  constexpr double kBetweenScans_s = 0.1;
  Rng rng(seed);
  ScanDrive drive;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    // the first and last velocities continue beyond the ends
    const std::size_t to = std::min(k + 1, poses.size() - 1), from = std::max<std::size_t>(k, 1) - 1;
    const auto twist = [&](std::size_t i, std::size_t j) {
      return SE3::Tangent((poses[i].inverse() * poses[j]).log() / kBetweenScans_s);
    };
    const SE3::Tangent ahead = to > k ? twist(k, to) : twist(from, k);
    const SE3::Tangent behind = from < k ? twist(from, k) : twist(k, to);
    const double fraction = scanner.stamp_at;
    drive.stamps.push_back(Stamp::from_seconds(kBetweenScans_s * static_cast<double>(k)));
    drive.truth.push_back(poses[k]);
    drive.scans.push_back(sweep(room, scanner, poses[k], rng, (1 - fraction) * ahead + fraction * behind));
  }
  return drive;
}

inline LidarLog log_of(const ScanDrive& drive) {
  return {drive.stamps, [scans = drive.scans](std::size_t k) { return scans[k]; }};
}

inline ScanPoses odometry_of(const ScanDrive& drive, const LidarParams& params = {}) {
  LidarOdometry odometer(scanner_traits(log_of(drive), params), params);
  ScanPoses poses;
  for (std::size_t k = 0; k < drive.scans.size(); ++k)
    poses.push_back(odometer.register_scan(drive.stamps[k], drive.scans[k]));
  return poses;
}

/// Random points without structure.
inline LidarScan noise_scan(ScannerKind kind, int count, Rng& rng) {
  LidarScan scan;
  for (int k = 0; k < count; ++k) {
    const double x = rng.uniform(-8, 8), y = rng.uniform(-8, 8), z = rng.uniform(-2, 3);
    scan.points.emplace_back(Eigen::Vector3d(x, y, kind == ScannerKind::kPlanar ? 0 : z).cast<float>());
  }
  return scan;
}

/// One lap of the furnished room, facing ahead.
inline std::vector<SE3> around_furnished_room(int steps) {
  std::vector<SE3> poses;
  for (int k = 0; k < steps; ++k) {
    const double angle = 2 * std::numbers::pi * k / steps;
    const double x = 2.4 * std::cos(angle), y = 0.9 * std::sin(angle);
    poses.push_back(pose_at(x, y, 1.2, std::atan2(0.9 * std::cos(angle), -2.4 * std::sin(angle))));
  }
  return poses;
}

/// A hall, 40 m by 24 m, with pillars of different girths and some crates.
inline ScannedRoom furnished_hall() {
  ScannedRoom hall;
  hall.boxes = {{{-20, -12, 0}, {20, 12, 5}},
                {{-12, 6, 0}, {-9, 8, 2.5}},
                {{4, -9, 0}, {6, -5, 2}},
                {{11, 5, 0}, {13, 9, 3}},
                {{-18, -10, 0}, {-15, -8, 4}}};
  Rng rng(77);
  for (int x = -1; x <= 1; ++x)
    for (const double y : {-4.0, 4.0}) {
      const double radius_m = rng.uniform(0.2, 0.5);
      hall.pillars.push_back({{11.0 * x + rng.uniform(-1, 1), y}, radius_m});
    }
  return hall;
}

/// Through the hall: 20 m along a slight curve.
inline std::vector<SE3> through_furnished_hall(int steps) {
  std::vector<SE3> poses{pose_at(-12, -0.5, 1.2, -0.3)};
  for (int k = 1; k < steps; ++k)
    poses.push_back(poses.back() * SE3::exp(planar_motion(24.0 / steps, 0, 0.6 / steps)));
  return poses;
}

}  // namespace radioslam::test
