// What robots' scans say of closures between them: held against one another as the closures lay them, they
// are of one world or not (places/seen_through.hpp).
#pragma once

#include <optional>
#include <vector>

#include "radioslam/joint/closures/closure.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/odometry/scan_stage.hpp"
#include "radioslam/places/seen_through.hpp"

namespace radioslam {

class MapWitness {
 public:
  /// Both must outlive it. `mission`: with the odometry of its scans.
  MapWitness(const Mission& mission, const MeasuredScans& scans);

  /// How much of either robot's structure lies in the other's free space. `closures`: of the same two robots,
  /// and consistent with one another. Nothing where either has no scans.
  SeenThrough held_against(const std::vector<const Closure*>& closures) const;

 private:
  PlacedKeyframes placed(std::size_t robot) const;
  /// The keyframe with a scan before this stamp, and the motion from there.
  std::optional<std::pair<std::size_t, SE3>> from_keyframe(RobotIndex robot, Stamp stamp) const;

  const Mission& mission_;
  const MeasuredScans& scans_;
  std::vector<std::vector<double>> path_m_;  ///< per robot and keyframe
};

}  // namespace radioslam
