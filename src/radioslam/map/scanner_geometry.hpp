// Where a scanner is on its robot, from its scans alone: missions give points in the body frame and do not
// say where they were measured from.
//
// The beams of a turning scanner have few elevations. Seen from the scanner itself they are sharp; seen from
// elsewhere, each is spread by the ranges of its returns. The position is the one from which the elevations
// have the least entropy, found coordinate by coordinate. Scanners without rings show no minimum and are
// taken to be at the body's origin.
// The ground is the most frequent height of returns below the scanner near the robot.
#pragma once

#include <Eigen/Core>

#include "radioslam/lidar/scan_points.hpp"
#include "radioslam/lidar/surfels/surfel.hpp"
#include "radioslam/mission/lidar.hpp"

namespace radioslam {

struct ScannerGeometry {
  Eigen::Vector3d scanner_m = Eigen::Vector3d::Zero();  ///< in the body frame
  double ground_m = 0;  ///< height of the ground relative to the body's origin
  double reach_m = 0;   ///< range within which almost all returns are
  double returns_per_scan = 0;
};

/// From a few scans, spread over the log. A planar scanner is at the body's origin, at the height of its
/// points.
ScannerGeometry scanner_geometry(const LidarLog& log, ScannerKind kind, const ScanPointParams& params);

}  // namespace radioslam
