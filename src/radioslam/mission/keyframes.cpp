#include "radioslam/mission/keyframes.hpp"

#include <algorithm>

namespace radioslam {

std::vector<std::size_t> select_keyframes(const Trajectory<SE3>& odometry, const KeyframeParams& params) {
  std::vector<std::size_t> keyframes;
  for (std::size_t i = 0; i < odometry.size(); ++i) {
    if (keyframes.empty() || i + 1 == odometry.size()) {
      keyframes.push_back(i);
      continue;
    }
    const SE3 step = odometry[keyframes.back()].pose.inverse() * odometry[i].pose;
    const double turn = step.log().tail<3>().norm();
    if (step.translation().norm() >= params.distance_m || turn >= params.angle_rad) keyframes.push_back(i);
  }
  return keyframes;
}

std::size_t keyframe_before(const std::vector<Stamp>& keyframes, Stamp stamp) {
  const auto after = std::upper_bound(keyframes.begin(), keyframes.end(), stamp);
  return after == keyframes.begin() ? 0 : static_cast<std::size_t>(after - keyframes.begin()) - 1;
}

}  // namespace radioslam
