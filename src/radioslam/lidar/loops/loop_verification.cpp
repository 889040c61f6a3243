#include "radioslam/lidar/loops/loop_verification.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {

std::vector<double> path_lengths(const std::vector<SE3>& poses) {
  std::vector<double> length_m(poses.size(), 0.0);
  for (std::size_t k = 1; k < poses.size(); ++k)
    length_m[k] = length_m[k - 1] + (poses[k - 1].inverse() * poses[k]).translation().norm();
  return length_m;
}

ScanLoop LoopVerification::verify(const PlacedKeyframes& target, std::size_t i, const PlacedKeyframes& source,
                                  std::size_t j, const UncertainPose<SE3>& T_i_j) const {
  const PoseSearch found = search_pose(submap_around(target, i, extents_.target_m), source_around(source, j),
                                       T_i_j, target.keyframes.kind, search_, registration_);
  ScanLoop loop{i, j, found.best.T_target_source};
  loop.inlier_ratio = found.best.inlier_ratio;
  loop.information = bounded(found.best.information);
  const double nominal_ratio =
      std::min(target.keyframes.nominal_inlier_ratio, source.keyframes.nominal_inlier_ratio);
  loop.status = status_of(found, T_i_j, nominal_ratio, loop);
  return loop;
}

ScanPyramid LoopVerification::source_around(const PlacedKeyframes& robot, std::size_t j) const {
  if (extents_.source_m == 0) return robot.keyframes.clouds[j];
  return scan_pyramid(submap_around(robot, j, extents_.source_m).fine().surfels(), robot.keyframes.spacing_m,
                      robot.keyframes.kind, map_params_);
}

LocalMap LoopVerification::submap_around(const PlacedKeyframes& robot, std::size_t i, double extent_m) const {
  LocalMap map(robot.keyframes.spacing_m, map_params_);
  const SE3 T_i_frame = robot.poses[i].inverse();
  std::optional<double> last_m;
  for (std::size_t k = 0; k < robot.poses.size(); ++k) {
    if (std::abs(robot.path_m[k] - robot.path_m[i]) > extent_m) continue;
    if (k != i && last_m && robot.path_m[k] - *last_m < extents_.apart_m) continue;
    map.add(robot.keyframes.clouds[k], T_i_frame * robot.poses[k], 0);
    last_m = robot.path_m[k];
  }
  return map;
}

LoopStatus LoopVerification::status_of(const PoseSearch& found, const UncertainPose<SE3>& expected,
                                       double nominal_ratio, const ScanLoop& loop) const {
  if (loop.inlier_ratio < params_.min_fit_ratio * nominal_ratio) return LoopStatus::kLowOverlap;
  if (found.next_ratio > params_.max_alternative_ratio * loop.inlier_ratio) return LoopStatus::kAmbiguous;
  const SE3::Tangent off = (expected.pose.inverse() * loop.T_i_j).log();
  const SE3::Jacobian covariance =
      expected.covariance + inverse<SE3::Jacobian>(loop.information + 1e-9 * SE3::Jacobian::Identity());
  if (off.dot(ldlt_solve(covariance, off)) > params_.gate) return LoopStatus::kContradictsOdometry;
  return LoopStatus::kAccepted;
}

SE3::Jacobian LoopVerification::bounded(const SE3::Jacobian& information) const {
  SE3::Tangent most;
  most.head<3>().setConstant(1 / (params_.min_sigma_m * params_.min_sigma_m));
  most.tail<3>().setConstant(1 / (params_.min_sigma_rad * params_.min_sigma_rad));
  const SE3::Jacobian limit = most.asDiagonal();
  const SE3::Jacobian bounded = limit - limit * ldlt_solve_matrix<SE3::Jacobian>(information + limit, limit);
  return 0.5 * (bounded + bounded.transpose());
}

}  // namespace radioslam
