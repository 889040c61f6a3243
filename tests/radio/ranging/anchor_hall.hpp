// Five anchors in a hall and a receiver's path among them.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/radio/ranging/range_epochs.hpp"

namespace radioslam::test {

/// Anchors in a hall of 25 x 23 m: the first at the origin, the second on +x, the third to the left.
inline Eigen::Matrix2Xd hall_anchors() {
  Eigen::Matrix2Xd points(2, 5);
  points << 0, 22, 25, 3, 11,  //
      0, 0, 21, 23, 9;
  return points;
}

/// Position on a curve through the hall.
inline Eigen::Vector2d hall_walk(double t_s) {
  return {12 + 9 * std::sin(0.11 * t_s), 11 + 8 * std::cos(0.17 * t_s)};
}

/// Ranges to all anchors simultaneously at 10 Hz; pairs are numbered by anchor.
inline std::vector<RangeEpoch> hall_epochs(Rng& rng, int epochs, double sigma_m,
                                           const Eigen::VectorXd& biases_m) {
  std::vector<RangeEpoch> result;
  const Eigen::Matrix2Xd anchors = hall_anchors();
  for (int k = 0; k < epochs; ++k) {
    RangeEpoch epoch{Stamp::from_seconds(0.1 * k), {}};
    for (Eigen::Index a = 0; a < anchors.cols(); ++a) {
      const double distance_m = (hall_walk(0.1 * k) - anchors.col(a)).norm();
      const auto anchor = static_cast<std::size_t>(a);
      epoch.ranges.push_back(
          {epoch.stamp, anchor, {anchor, distance_m + biases_m[a] + rng.normal(0, sigma_m), sigma_m}});
    }
    result.push_back(epoch);
  }
  return result;
}

}  // namespace radioslam::test
