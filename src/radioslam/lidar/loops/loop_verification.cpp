#include "radioslam/lidar/loops/loop_verification.hpp"

#include <Eigen/LU>
#include <cmath>

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {

ScanLoop LoopVerification::verify(const LoopCandidate& candidate, const std::vector<SE3>& poses) const {
  const PoseSearch found = search_pose(submap_around(candidate.i, poses), keyframes_.clouds[candidate.j],
                                       candidate.T_i_j, keyframes_.kind, search_, registration_);
  ScanLoop loop{candidate.i, candidate.j, found.best.T_target_source};
  loop.inlier_ratio = found.best.inlier_ratio;
  loop.information = bounded(found.best.information);
  loop.status = status_of(found, candidate, loop);
  return loop;
}

LocalMap LoopVerification::submap_around(std::size_t i, const std::vector<SE3>& poses) const {
  LocalMap map(keyframes_.spacing_m, map_params_);
  const SE3 T_i_frame = poses[i].inverse();
  for (std::size_t k = 0; k < poses.size(); ++k)
    if (std::abs(path_m_[k] - path_m_[i]) <= params_.submap_m)
      map.add(keyframes_.clouds[k], T_i_frame * poses[k], 0);
  return map;
}

LoopStatus LoopVerification::status_of(const PoseSearch& found, const LoopCandidate& candidate,
                                       const ScanLoop& loop) const {
  if (loop.inlier_ratio < params_.min_fit_ratio * keyframes_.nominal_inlier_ratio)
    return LoopStatus::kLowOverlap;
  if (found.next_ratio > params_.max_alternative_ratio * loop.inlier_ratio) return LoopStatus::kAmbiguous;
  const SE3::Tangent off = (candidate.T_i_j.pose.inverse() * loop.T_i_j).log();
  const SE3::Jacobian covariance =
      candidate.T_i_j.covariance +
      inverse<SE3::Jacobian>(loop.information + 1e-9 * SE3::Jacobian::Identity());
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
