#include "radioslam/joint/places/scanned_robot.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "radioslam/base/parallel.hpp"

namespace radioslam {
namespace {

constexpr double kRangeQuantile = 0.9;  // of the points' ranges: that of the descriptors
constexpr double kMinRange_m = 3, kMaxRange_m = 80;

/// Horizontal range within which most points lie; 0 without points.
double range_of(const ScannedRobot& robot) {
  std::vector<float> ranges_m;
  for (std::size_t k = 0; k < robot.size(); ++k)
    for (const Surfel& surfel : robot.cloud(k).all) ranges_m.push_back(surfel.position.head<2>().norm());
  if (ranges_m.empty()) return 0;
  const auto at = ranges_m.begin() +
                  static_cast<std::ptrdiff_t>(kRangeQuantile * static_cast<double>(ranges_m.size() - 1));
  std::nth_element(ranges_m.begin(), at, ranges_m.end());
  return static_cast<double>(*at);
}

/// Points of the keyframe's scan; of a planar scanner, which sees little at once, with those of the scans
/// around it.
std::vector<Eigen::Vector3f> points_around(const ScannedRobot& robot, std::size_t k, double submap_m) {
  std::vector<Eigen::Vector3f> points;
  const std::vector<SE3>& poses = robot.scans->keyframes.poses;
  for (std::size_t n = 0; n < robot.size(); ++n) {
    if (n != k &&
        (robot.kind() == ScannerKind::kSpatial || std::abs(robot.path_m[n] - robot.path_m[k]) > submap_m))
      continue;
    const SE3 T = poses[k].inverse() * poses[n];
    for (const Surfel& surfel : transformed(T, robot.cloud(n).all)) points.push_back(surfel.position);
  }
  return points;
}

}  // namespace

ScannedRobot scanned_robot(const ScanOdometry& scans, const RobotVariables& variables,
                           const Trajectory<SE3>& odometry) {
  ScannedRobot robot{&scans};
  robot.path_m = path_lengths(scans.keyframes.poses);
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
                  double submap_m) {
  double range_m = params.max_range_m > 0 ? params.max_range_m : kMaxRange_m;
  for (const ScannedRobot& robot : robots)
    if (robot.size() > 0 && robot.kind() == kind && params.max_range_m == 0)
      if (const double own_m = range_of(robot); own_m > 0)
        range_m = std::min(range_m, std::max(own_m, kMinRange_m));
  const auto context_kind =
      kind == ScannerKind::kSpatial ? ScanContextKind::kHeight : ScanContextKind::kOccupancy;
  for (ScannedRobot& robot : robots) {
    if (robot.size() == 0 || robot.kind() != kind) continue;
    std::vector<std::optional<ScanContext>> contexts(robot.size());
    parallel_for(robot.size(), 4, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        contexts[k] = make_scan_context(points_around(robot, k, submap_m), range_m, context_kind, params);
    });
    robot.context_range_m = range_m;
    for (auto& context : contexts) robot.contexts.push_back(std::move(*context));
  }
}

}  // namespace radioslam
