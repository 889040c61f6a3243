// Scans of a robot read once more from disk, deskewed by and placed on its final continuous trajectory.
//
// The body moves between two poses of the trajectory along a geodesic, also during a sweep; a sweep that ends
// after the last pose goes on as before it. Cost: one scan in memory at a time.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/lidar/scan_matcher.hpp"
#include "radioslam/lidar/scan_points.hpp"
#include "radioslam/map/scanner_geometry.hpp"
#include "radioslam/mission/lidar.hpp"

namespace radioslam {

/// A robot whose scans are mapped.
struct MappedRobot {
  std::string id;
  LidarLog scans;         ///< at least one
  Trajectory<SE3> poses;  ///< T_frame_body, final; at least one
  ScannerKind kind = ScannerKind::kSpatial;
  ScannerGeometry geometry;
};

/// With what its scans say of the scanner.
MappedRobot mapped_robot(std::string id, LidarLog scans, Trajectory<SE3> poses, const LidarParams& params);

/// A scan with its returns in the body frame at its stamp.
struct PlacedScan {
  std::size_t robot = 0;
  Stamp stamp;
  SE3 T_frame_body;
  ScanPoints returns;
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();  ///< of the scanner, in the body frame at the stamp
};

/// Scans covered by the trajectory that are this far from the one before, or this much later.
std::vector<std::size_t> scans_apart(const MappedRobot& robot, double step_m, double step_s);

/// Scan k of the robot with an even `share` of its returns, at most 1. The same returns in every call.
PlacedScan place_scan(const MappedRobot& robot, std::size_t k, const ScanPointParams& params, double share);

}  // namespace radioslam
