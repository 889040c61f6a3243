#include "radioslam/pipeline/map_drift.hpp"

#include <Eigen/Cholesky>

namespace radioslam {
MapDrift::MapDrift(const ScanPose& from, const InertialStageParams& params)
    : params_(params),
      T_from_map_(from.T_start_body.inverse()),
      T_map_last_(from.T_start_body),
      next_(added_by(from)) {
  constexpr double kLeast_m = 1e-5, kLeast_rad = 1e-6;  // what numbers carry
  covariance_ = isotropic(kLeast_m * kLeast_m, kLeast_rad * kLeast_rad);
}

SE3::Jacobian MapDrift::added_by(const ScanPose& scan) const {
  const SE3::Jacobian information =
      scan.information + isotropic(1 / (params_.unmeasured_m * params_.unmeasured_m),
                                   1 / (params_.unmeasured_rad * params_.unmeasured_rad));
  return scan.new_share * scan.new_share * information.llt().solve(SE3::Jacobian::Identity());
}

void MapDrift::take(const SE3& T_map_body, const SE3::Jacobian& covariance) {
  const SE3::Jacobian to_from = (T_from_map_ * T_map_body).adjoint();
  covariance_ += to_from * covariance * to_from.transpose();
}

void MapDrift::add(const ScanPose& scan) {
  if (scan.outcome == ScanOutcome::kNewMap)
    take(scan.T_start_body, scan.covariance);
  else
    take(T_map_last_, next_);
  T_map_last_ = scan.T_start_body;
  next_ = added_by(scan);
}

MapPose map_pose(const ScanPose& scan, const InertialStageParams& params) {
  return {scan.T_start_body, scan.information, params.outlier_sigmas};
}

}  // namespace radioslam
