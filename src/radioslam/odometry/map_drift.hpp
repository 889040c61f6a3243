// Covariance of the drift of the scan matching map between two scans.
//
// On a fixed map a scan's pose error is that of its own registration. The map grows by the scans: if a
// fraction f_k of scan k is new and its registration errs by e_k, everything that follows moves by f_k e_k:
//   D_ij = sum_k f_k^2 Ad(T_i_k) C_k Ad(T_i_k)',  i <= k < j,   C_k = (I_k + U)^-1
// where U is the information of a pose that is not measured at all (`unmeasured_m`, `unmeasured_rad`). The
// correlation of e_i with scan i's own pose is neglected. So the map drifts along a featureless corridor and
// stays on known ground. A new map (ScanStatus::kNewMap) adds the covariance of the step onto it.
// D_ij is the covariance of Exp(xi) in body i's frame: [translation, rotation], m^2, rad^2. Cost: 6 x 6
// products per scan.
#pragma once

#include "radioslam/inertial/state_factors.hpp"
#include "radioslam/lidar/lidar_odometry.hpp"
#include "radioslam/odometry/inertial_params.hpp"

namespace radioslam {

class MapDrift {
 public:
  MapDrift(const ScanPose& from, const InertialStageParams& params);

  /// Adds the next registered scan.
  void add(const ScanPose& scan);

  /// Drift from the first scan to the last one added; positive definite.
  const SE3::Jacobian& covariance() const { return covariance_; }

 private:
  /// Covariance that a scan adds, in its body frame.
  SE3::Jacobian added_by(const ScanPose& scan) const;
  void take(const SE3& T_map_body, const SE3::Jacobian& covariance);

  InertialStageParams params_;
  SE3 T_from_map_, T_map_last_;
  SE3::Jacobian next_, covariance_;
};

/// A scan's pose on its map with the information of its points alone.
MapPose map_pose(const ScanPose& scan, const InertialStageParams& params);

}  // namespace radioslam
