// A random town of boxes, drives along its streets that revisit places, and a fast simulation of a LiDAR with
// stacked beams in it: per azimuth, boxes hide what is behind them below their own upper edges.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "radioslam/base/random.hpp"

namespace radioslam::test {

/// Stands on the ground, sides along x and y.
struct TownBox {
  Eigen::Vector2d low, high;
  double height_m = 0;
};

struct TownPose {
  Eigen::Vector2d position;
  double yaw_rad = 0;
};

struct TownScanner {
  double height_m = 1.7;
  double max_range_m = 80;
  int azimuths = 360, beams = 24;
  double lowest_rad = -0.3, highest_rad = 0.3;
  double sigma_m = 0.03;
  double dropout_ratio = 0.1;
};

/// Streets run along x and y through the crossings.
struct Town {
  int blocks = 0;
  double block_m = 60;
  std::vector<TownBox> boxes;
};

/// Houses of random sizes with gaps around every block, and trees and cars along the streets.
inline Town random_town(int blocks, Rng& rng) {
  Town town;
  town.blocks = blocks;
  const auto add = [&](double x, double y, double wide, double deep, double high) {
    town.boxes.push_back({{x, y}, {x + wide, y + deep}, high});
  };
  const double side = town.block_m;
  for (int i = 0; i < blocks; ++i) {
    for (int j = 0; j < blocks; ++j) {
      const double x0 = i * side, y0 = j * side;
      for (int edge = 0; edge < 4; ++edge) {
        for (double at = 7 + rng.uniform(0, 4); at < side - 14; at += rng.uniform(9, 22)) {
          const double wide = rng.uniform(5, 13), deep = rng.uniform(5, 12), back = 6 + rng.uniform(0, 5);
          const double high = rng.uniform(3, 14);
          const double far = edge % 2 == 0 ? back : side - back - deep;
          edge < 2 ? add(x0 + at, y0 + far, wide, deep, high) : add(x0 + far, y0 + at, deep, wide, high);
        }
        for (double at = 4 + rng.uniform(0, 10); at < side - 6; at += rng.uniform(5, 30)) {
          const bool is_tree = rng.uniform() < 0.5;
          const double wide = is_tree ? rng.uniform(0.4, 3) : 4, deep = is_tree ? wide : 1.8;
          const double high = is_tree ? rng.uniform(3, 9) : 1.5, off = rng.uniform(3.5, 4);
          const double far = edge % 2 == 0 ? off : side - off - deep;
          edge < 2 ? add(x0 + at, y0 + far, wide, deep, high) : add(x0 + far, y0 + at, deep, wide, high);
        }
      }
    }
  }
  return town;
}

/// Places every `step_m` along a random walk over the crossings, which turns back only where it has to.
inline std::vector<TownPose> drive(const Town& town, std::size_t count, double step_m, Rng& rng) {
  std::vector<TownPose> poses;
  const Eigen::Vector2d along[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  const auto crossings = static_cast<std::uint64_t>(town.blocks) + 1;
  Eigen::Vector2d at;
  for (double& coordinate : at) coordinate = static_cast<double>(rng.below(crossings));
  std::size_t heading = 0;
  for (double left_m = 0; poses.size() < count;) {
    std::size_t next = rng.below(4);
    const Eigen::Vector2d to = at + along[next];
    if (next == (heading + 2) % 4 || to.minCoeff() < 0 || to.maxCoeff() > town.blocks) {
      if (rng.uniform() < 0.1) heading = rng.below(4);  // out of a corner
      continue;
    }
    heading = next;
    for (; left_m < town.block_m && poses.size() < count; left_m += step_m) {
      const Eigen::Vector2d side(-along[next].y(), along[next].x());
      poses.push_back({at * town.block_m + left_m * along[next] - rng.uniform(0.5, 2.5) * side,
                       std::atan2(along[next].y(), along[next].x()) + rng.normal(0, 0.05)});
    }
    left_m -= town.block_m;
    at = to;
  }
  return poses;
}

/// A place up to `most_m` away, with any yaw.
inline TownPose revisited(const TownPose& pose, double most_m, Rng& rng) {
  const double azimuth = rng.uniform(0, 2 * std::numbers::pi), far_m = rng.uniform(0, most_m);
  return {pose.position + far_m * Eigen::Vector2d(std::cos(azimuth), std::sin(azimuth)),
          rng.uniform(-std::numbers::pi, std::numbers::pi)};
}

/// Where a ray enters a box, and its height.
struct TownHit {
  double range_m, height_m;
};

/// Per azimuth of the scanner in the body frame, what its vertical plane meets.
inline std::vector<std::vector<TownHit>> town_hits(const Town& town, const TownPose& pose,
                                                   const TownScanner& scanner) {
  std::vector<std::vector<TownHit>> hits(static_cast<std::size_t>(scanner.azimuths));
  const double step = 2 * std::numbers::pi / scanner.azimuths;
  for (const TownBox& box : town.boxes) {
    const Eigen::Vector2d low = box.low - pose.position, high = box.high - pose.position;
    const Eigen::Vector2d nearest = Eigen::Vector2d::Zero().cwiseMax(low).cwiseMin(high);
    if (nearest.norm() > scanner.max_range_m || nearest.isZero()) continue;
    const double middle = std::atan2(low.y() + high.y(), low.x() + high.x());
    double half = 0;
    for (const auto& [x, y] : {std::pair(low.x(), low.y()), std::pair(low.x(), high.y()),
                               std::pair(high.x(), low.y()), std::pair(high.x(), high.y())})
      half = std::max(half, std::abs(std::remainder(std::atan2(y, x) - middle, 2 * std::numbers::pi)));
    const auto first = static_cast<int>(std::ceil((middle - half - pose.yaw_rad) / step));
    const auto last = static_cast<int>(std::floor((middle + half - pose.yaw_rad) / step));
    for (int k = first; k <= last; ++k) {
      const double c = std::cos(k * step + pose.yaw_rad), s = std::sin(k * step + pose.yaw_rad);
      const double x_m = std::min(low.x() / c, high.x() / c), y_m = std::min(low.y() / s, high.y() / s);
      const double range_m = std::max(x_m, y_m);
      const int around = (k % scanner.azimuths + scanner.azimuths) % scanner.azimuths;
      if (range_m > 0) hits[static_cast<std::size_t>(around)].push_back({range_m, box.height_m});
    }
  }
  return hits;
}

/// Body frame at the scanner, x forward, z up.
inline std::vector<Eigen::Vector3f> scan_town(const Town& town, const TownPose& pose,
                                              const TownScanner& scanner, Rng& rng) {
  auto hits = town_hits(town, pose, scanner);
  std::vector<Eigen::Vector3f> points;
  for (int k = 0; k < scanner.azimuths; ++k) {
    auto& along = hits[static_cast<std::size_t>(k)];
    std::sort(along.begin(), along.end(),
              [](const TownHit& a, const TownHit& b) { return a.range_m < b.range_m; });
    const double azimuth = 2 * std::numbers::pi * k / scanner.azimuths;
    std::size_t hit = 0;
    for (int beam = 0; beam < scanner.beams; ++beam) {
      const double slope = std::tan(scanner.lowest_rad + (scanner.highest_rad - scanner.lowest_rad) * beam /
                                                             std::max(1, scanner.beams - 1));
      // A steeper beam passes over whatever the beam below it passed over.
      while (hit < along.size() && scanner.height_m + slope * along[hit].range_m > along[hit].height_m) ++hit;
      double range_m = hit < along.size() ? along[hit].range_m : 2 * scanner.max_range_m;
      if (slope < 0) range_m = std::min(range_m, -scanner.height_m / slope);  // the ground
      if (range_m > scanner.max_range_m || rng.uniform() < scanner.dropout_ratio) continue;
      range_m += rng.normal(0, scanner.sigma_m);
      points.push_back(Eigen::Vector3d(range_m * std::cos(azimuth), range_m * std::sin(azimuth),
                                       range_m * slope + rng.normal(0, scanner.sigma_m))
                           .cast<float>());
    }
  }
  return points;
}

}  // namespace radioslam::test
