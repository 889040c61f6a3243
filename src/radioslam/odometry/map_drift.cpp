#include "radioslam/odometry/map_drift.hpp"

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
MapDrift::MapDrift(const ScanPose& from, const InertialStageParams& params)
    : params_(params),
      T_from_map_(from.T_start_body.inverse()),
      T_map_last_(from.T_start_body),
      next_(added_by(from)) {
  constexpr double kMin_m = 1e-5, kMin_rad = 1e-6;  // numerical floor
  covariance_ = isotropic(kMin_m * kMin_m, kMin_rad * kMin_rad);
}

SE3::Jacobian MapDrift::added_by(const ScanPose& scan) const {
  const SE3::Jacobian information =
      scan.information + isotropic(1 / (params_.unmeasured_m * params_.unmeasured_m),
                                   1 / (params_.unmeasured_rad * params_.unmeasured_rad));
  return scan.novelty_ratio * scan.novelty_ratio * Cholesky<SE3::Jacobian>(information).inverse();
}

void MapDrift::take(const SE3& T_map_body, const SE3::Jacobian& covariance) {
  const SE3::Jacobian to_from = (T_from_map_ * T_map_body).adjoint();
  covariance_ = congruence(to_from, covariance, covariance_);
}

void MapDrift::add(const ScanPose& scan) {
  if (scan.status == ScanStatus::kNewMap)
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
