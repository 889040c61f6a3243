// Scans and inertial readings of one robot together, after the scans were laid: the smoother
// (inertial/inertial_smoother.hpp) estimates all states at once; of the scans it takes what their points
// tell, nothing along a corridor without features.
//
// Successive scans lie on one map, so the error of the motion between two of them does not grow with the
// number of scans in between. States therefore stand `node_s` apart, and the motion from one to the next has
// the information of one registration; the scans in between are bent along.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/lidar/scan_odometry.hpp"
#include "radioslam/mission/inertial.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/pipeline/inertial_params.hpp"

namespace radioslam {

/// A step between two registered scans, as their points alone tell it.
PoseStep scan_step(const ScanPose& from, const ScanPose& to, const InertialStageParams& params);

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
