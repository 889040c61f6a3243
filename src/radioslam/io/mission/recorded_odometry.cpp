#include "radioslam/io/mission/recorded_odometry.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "radioslam/geometry/so3.hpp"

namespace radioslam {
namespace {

constexpr double kPlaneHeight_m = 0.1, kPlaneTilt = 0.05;  ///< the latter is the sine of half the tilt

}  // namespace

Trajectory<SE3> from_start(std::vector<StampedPose<SE3>> poses) {
  if (poses.empty()) return {};
  const SE3& first = poses.front().pose;
  const SE3 T_start = SE3(first.translation(), so3_exp({0, 0, first.yaw()})).inverse();
  for (auto& entry : poses) entry.pose = T_start * entry.pose;
  return Trajectory<SE3>(std::move(poses));
}

bool is_in_plane(const Trajectory<SE3>& poses) {
  return std::all_of(poses.begin(), poses.end(), [](const StampedPose<SE3>& entry) {
    const Eigen::Quaterniond& rotation = entry.pose.rotation();
    return std::abs(entry.pose.translation().z()) < kPlaneHeight_m &&
           std::hypot(rotation.x(), rotation.y()) < kPlaneTilt;
  });
}

}  // namespace radioslam
