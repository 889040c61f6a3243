#include "radioslam/joint/places/scanned_robot.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

constexpr double kLeastApart_m = 1;  // of places whose grids are said; they look alike from any heading

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

std::vector<ScannedPlace> scanned_places(const MeasuredScans& scans, const PlaceDescriptorParams& params,
                                         double submap_m) {
  const TeamDescriptors team = describe_places(scans, params, submap_m);
  std::vector<ScannedPlace> places;
  for (std::size_t r = 0; r < team.robots.size(); ++r) {
    if (!team.robots[r].index) continue;
    const ScanOdometry& robot = *scans.robots[r];
    std::optional<Eigen::Vector3d> last;
    for (std::size_t k = 0; k < team.robots[r].index->size(); ++k) {
      const ScanContext& context = team.robots[r].index->context(k);
      const Eigen::Vector3d here = robot.keyframes.poses[k].translation();
      if (context.empty() || (last && (here - *last).norm() < kLeastApart_m)) continue;
      last = here;
      ScannedPlace& place = places.emplace_back();
      place.robot = RobotIndex(r);
      place.stamp = robot.keyframe_stamps[k];
      DescriptorRecord& grid = place.grid;
      const Eigen::MatrixXf bins = context.bins();
      grid.is_occupancy = robot.keyframes.kind == ScannerKind::kPlanar;
      grid.range_m = team.robots[r].range_m;
      grid.step = static_cast<double>(bins.maxCoeff()) / (grid.is_occupancy ? 1 : kMostBin);
      grid.rings = static_cast<std::uint32_t>(context.rings());
      grid.sectors = static_cast<std::uint32_t>(context.sectors());
      for (Eigen::Index i = 0; i < bins.rows(); ++i)
        for (Eigen::Index j = 0; j < bins.cols(); ++j) {
          const double steps = static_cast<double>(bins(i, j)) / grid.step;
          grid.bins.push_back(steps > 0 ? static_cast<std::uint8_t>(std::max(1L, std::lround(steps))) : 0);
        }
    }
  }
  return places;
}

ScanLoop loop_of(const ScannedClosure& said) {
  ScanLoop loop;
  loop.T_i_j = said.T_i_j;
  loop.information = inverse<SE3::Jacobian>(said.covariance);
  loop.inlier_ratio = said.inlier_ratio;
  loop.doubt = said.doubt;
  return loop;
}

}  // namespace radioslam
