// Pose of a scan by LiDAR odometry, with its covariance and how it was found.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/lidar/lidar_params.hpp"
#include "radioslam/lidar/local_map.hpp"
#include "radioslam/lidar/scan_points.hpp"

namespace radioslam {

/// Detects gaps in a sequence of scans: intervals many times as long as the nominal one, a running mean.
class ScanGapDetector {
 public:
  explicit ScanGapDetector(const LidarOdometryParams& params) : params_(params) {}

  /// Adds the next scan; whether it is more than `max_lost_scans` nominal intervals after the last one.
  bool is_after_gap(Stamp stamp);

 private:
  LidarOdometryParams params_;
  std::optional<Stamp> newest_;
  double interval_s_ = 0;  ///< nominal; 0: not known yet
};

enum class ScanStatus {
  kRegistered,
  kMapStart,      ///< first scan of the map
  kTooFewPoints,  ///< too few usable points
  kLost,          ///< does not match the map
  kNewMap,        ///< registered on a new map; the step to it is highly uncertain
};

/// Whether the scan's pose belongs to the trajectory.
constexpr bool is_tracked(ScanStatus status) {
  return status == ScanStatus::kRegistered || status == ScanStatus::kMapStart ||
         status == ScanStatus::kNewMap;
}

/// A scan's pose in the frame of the robot's start, with how it was registered.
struct ScanPose {
  Stamp stamp;
  SE3 T_start_body;
  SE3::Jacobian covariance = SE3::Jacobian::Zero();   ///< of the step from the previous registered scan
  SE3::Jacobian information = SE3::Jacobian::Zero();  ///< of the pose on the map, without the prior
  ScanStatus status = ScanStatus::kTooFewPoints;
  double novelty_ratio = 0;  ///< fraction of its points that were inserted into the map
  double inlier_ratio = 0;
  double normalised_rms = 0;
  int iterations = 0;
  PointCounts counts;
  ScanPyramid cloud = {};  ///< in the body frame; empty with too few points
  /// The previous scan, if it started the map: deskewed again now that the motion is known.
  std::optional<ScanPyramid> first_cloud = {};
};

Trajectory<SE3> trajectory_of(const std::vector<ScanPose>& scans);

}  // namespace radioslam
