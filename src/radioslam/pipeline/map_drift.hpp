// How far the map that scans are laid onto may drift, from one scan to a later one.
//
// Scans lie on one map: the error of a scan's pose on it is that of its registration, whatever lies between.
// But the map grows by the scans. One of which a share f_k is new and whose registration errs by e_k moves
// all that follows by f_k e_k:
//   D_ij = sum_k f_k^2 Ad(T_i_k) C_k Ad(T_i_k)',  i <= k < j,   C_k = (I_k + U)^-1
// with the deviations U of what is not measured at all (`unmeasured_m`, `unmeasured_rad`). That e_i is also
// the error of scan i's own pose is left out of account. So along a corridor without features the map comes
// loose from where it began, while over known ground it stays. A new map (ScanOutcome::kNewMap) lies anywhere
// about the one before, by the covariance of the step to it.
// D_ij is that of Exp(xi) in body i's frame: [translation, rotation], m^2, rad^2. Cost: 6 x 6 products a
// scan.
#pragma once

#include "radioslam/inertial/state_factors.hpp"
#include "radioslam/lidar/scan_odometry.hpp"
#include "radioslam/pipeline/inertial_params.hpp"

namespace radioslam {

class MapDrift {
 public:
  MapDrift(const ScanPose& from, const InertialStageParams& params);

  /// The next registered scan.
  void add(const ScanPose& scan);

  /// From the first scan to the last one added; positive definite.
  const SE3::Jacobian& covariance() const { return covariance_; }

 private:
  /// What a scan adds, in its body's frame.
  SE3::Jacobian added_by(const ScanPose& scan) const;
  void take(const SE3& T_map_body, const SE3::Jacobian& covariance);

  InertialStageParams params_;
  SE3 T_from_map_, T_map_last_;
  SE3::Jacobian next_, covariance_;
};

/// Where a scan lies on its map, as its points alone tell.
MapPose map_pose(const ScanPose& scan, const InertialStageParams& params);

}  // namespace radioslam
