#include "radioslam/mission/keyframes.hpp"

#include <algorithm>

namespace radioslam {

bool is_new_keyframe(const SE3& last, const SE3& pose, const KeyframeParams& params) {
  const SE3 step = last.inverse() * pose;
  return step.translation().norm() >= params.distance_m || step.log().tail<3>().norm() >= params.angle_rad;
}

std::vector<std::size_t> select_keyframes(const Trajectory<SE3>& odometry, const KeyframeParams& params) {
  std::vector<std::size_t> keyframes;
  for (std::size_t i = 0; i < odometry.size(); ++i) {
    if (keyframes.empty() || i + 1 == odometry.size()) {
      keyframes.push_back(i);
      continue;
    }
    if (is_new_keyframe(odometry[keyframes.back()].pose, odometry[i].pose, params)) keyframes.push_back(i);
  }
  return keyframes;
}

std::size_t keyframe_before(const std::vector<Stamp>& keyframes, Stamp stamp) {
  const auto after = std::upper_bound(keyframes.begin(), keyframes.end(), stamp);
  return after == keyframes.begin() ? 0 : static_cast<std::size_t>(after - keyframes.begin()) - 1;
}

}  // namespace radioslam
