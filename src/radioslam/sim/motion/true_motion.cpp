#include "radioslam/sim/motion/true_motion.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "radioslam/base/check.hpp"
#include "radioslam/sim/motion/stamps.hpp"

namespace radioslam {

TrueMotion::TrueMotion(Trajectory<SE3> poses) : motion_(std::move(poses)) {
  const auto& own = std::get<Trajectory<SE3>>(motion_);
  RADIOSLAM_CHECK(!own.empty() && own.front().stamp <= Stamp{}, "a motion is defined from time 0");
}

TrueMotion::TrueMotion(SplineMotion curve) : motion_(std::move(curve)) {}

Stamp TrueMotion::end() const {
  if (const auto* curve = std::get_if<SplineMotion>(&motion_)) return Stamp::from_seconds(curve->end_s());
  return std::get<Trajectory<SE3>>(motion_).back().stamp;
}

SE3 TrueMotion::pose_at(Stamp stamp) const {
  if (smooth()) return state_at(stamp).T_common_body;
  return *std::get<Trajectory<SE3>>(motion_).at(std::clamp(stamp, Stamp{}, end()));
}

MotionState TrueMotion::state_at(Stamp stamp) const {
  RADIOSLAM_CHECK(smooth(), "accelerations need a smooth motion");
  return std::get<SplineMotion>(motion_).at(stamp);
}

Trajectory<SE3> TrueMotion::poses(double rate_hz) const {
  std::vector<StampedPose<SE3>> poses;
  for (const Stamp stamp : regular_stamps(0, end().seconds(), rate_hz))
    poses.push_back({stamp, pose_at(stamp)});
  return Trajectory<SE3>(std::move(poses));
}

}  // namespace radioslam
