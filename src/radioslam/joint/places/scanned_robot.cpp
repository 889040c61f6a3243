#include "radioslam/joint/places/scanned_robot.hpp"

#include <algorithm>
#include <utility>

namespace radioslam {

ScannedRobot scanned_robot(const ScanOdometry& scans, const RobotVariables& variables,
                           const Trajectory<SE3>& odometry) {
  ScannedRobot robot{&scans};
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

void add_contexts(std::vector<ScannedRobot>& robots, ScannerKind kind, const ScanContextParams& params,
                  const ScanContextIndexParams& index, double submap_m) {
  constexpr double kLargest_m = 80;
  double range_m = params.max_range_m > 0 ? params.max_range_m : kLargest_m;
  for (const ScannedRobot& robot : robots)
    if (robot.size() > 0 && robot.kind() == kind && params.max_range_m == 0)
      if (const double own_m = context_range(robot.scans->keyframes); own_m > 0)
        range_m = std::min(range_m, own_m);
  for (ScannedRobot& robot : robots) {
    if (robot.size() == 0 || robot.kind() != kind) continue;
    robot.context_range_m = range_m;
    robot.contexts.emplace(index);
    for (ScanContext& context :
         keyframe_contexts(robot.scans->keyframes, robot.path_m, range_m, submap_m, params))
      robot.contexts->add(std::move(context));
  }
}

}  // namespace radioslam
