#include "radioslam/joint/places/scanned_robot.hpp"

#include <algorithm>
#include <utility>

namespace radioslam {
namespace {

/// The least range of all robots' scanners of this kind.
double common_range_m(const MeasuredScans& scans, ScannerKind kind) {
  constexpr double kLargest_m = 80;
  double range_m = kLargest_m;
  for (const std::optional<ScanOdometry>& robot : scans.robots)
    if (robot && robot->keyframes.kind == kind)
      if (const double own_m = context_range(robot->keyframes); own_m > 0) range_m = std::min(range_m, own_m);
  return range_m;
}

}  // namespace

PlacedKeyframes placed_keyframes(const ScanOdometry& scans, const std::vector<double>& path_m,
                                 const ScanContextIndex* contexts) {
  const ScanKeyframes& keyframes = scans.keyframes;
  return {keyframes, scans.corrected.empty() ? keyframes.poses : scans.corrected, path_m, contexts,
          [&](std::size_t i, std::size_t j) { return odometry_sigma_m(keyframes, path_m, i, j); }};
}

ScannedRobot scanned_robot(const ScanOdometry& scans, const RobotDescriptors& descriptors,
                           const RobotVariables& variables, const Trajectory<SE3>& odometry) {
  ScannedRobot robot{&scans};
  robot.contexts = descriptors.index ? &*descriptors.index : nullptr;
  robot.context_range_m = descriptors.range_m;
  robot.path_m = path_lengths(scans.keyframes);
  for (const Stamp stamp : scans.keyframe_stamps) {
    const std::size_t k = keyframe_before(variables.stamps, stamp);
    robot.keyframes.push_back(k);
    robot.nodes.push_back(variables.poses[k]);
    const auto at_scan = odometry.at(stamp), at_node = odometry.at(variables.stamps[k]);
    robot.T_node_scan.push_back(at_scan && at_node ? at_node->inverse() * *at_scan : SE3());
  }
  return robot;
}

TeamDescriptors describe_places(const MeasuredScans& scans, const PlaceDescriptorParams& params,
                                double submap_m) {
  TeamDescriptors team;
  for (const std::optional<ScanOdometry>& robot : scans.robots) {
    RobotDescriptors& described = team.robots.emplace_back();
    if (!robot || robot->keyframe_stamps.empty()) continue;
    const ScanKeyframes& keyframes = robot->keyframes;
    described.range_m =
        params.context.max_range_m > 0 ? params.context.max_range_m : common_range_m(scans, keyframes.kind);
    described.index = keyframe_index(keyframes, path_lengths(keyframes), described.range_m, submap_m, params);
  }
  return team;
}

}  // namespace radioslam
