// Scans and inertial readings of one robot together, after the scans were laid: the smoother
// (inertial/inertial_smoother.hpp) estimates all states at once; of the scans it takes what their points
// tell, nothing along a corridor without features.
//
// Scans lie on one map, which drifts as it grows (map_drift.hpp): over known ground poses from scans do not
// drift, and readings add nothing to their error. States stand `node_s` apart, for the
// errors of successive scans are nearly the same one; in between the readings lead, or the scans where
// readings are missing.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/lidar/scan_odometry.hpp"
#include "radioslam/mission/inertial.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/pipeline/inertial_params.hpp"

namespace radioslam {

/// What scans and readings say together; z is up.
struct InertialOdometry {
  std::vector<SE3> poses;                ///< of the scans
  std::vector<OdometryStepNoise> steps;  ///< from state to state
  double cost_per_step = 0;              ///< of the least squares
};

/// Nothing where gravity is not found or the smoother refuses.
std::optional<InertialOdometry> smooth_scans(const std::vector<ScanPose>& scans,
                                             const std::vector<InertialSample>& samples,
                                             const InertialParams& params);

}  // namespace radioslam
