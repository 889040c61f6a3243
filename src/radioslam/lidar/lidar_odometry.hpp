// LiDAR odometry: registers each scan to a local surfel map and returns its pose with covariance.
//
//   predict     constant velocity or a given motion, by which the points are deskewed     (deskew.hpp)
//   register    generalised ICP to the map, from other poses if the scan fits badly       (pose_search.hpp)
//   deskew      by the registered motion; then registered again                      (candidate_map.hpp)
//   adapt       thresholds to the prediction's error                              (prediction_error.hpp)
//   map         insert what is new; scans that fit only each other replace the map     (candidate_map.hpp)
//
// Why each step is as it is: docs/lidar_odometry.md.
#pragma once

#include <deque>
#include <optional>

#include "radioslam/base/stamp.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/lidar/candidate_map.hpp"
#include "radioslam/lidar/lidar_params.hpp"
#include "radioslam/lidar/local_map.hpp"
#include "radioslam/lidar/prediction_error.hpp"
#include "radioslam/lidar/scan_matcher.hpp"
#include "radioslam/lidar/scan_points.hpp"
#include "radioslam/lidar/scan_structure.hpp"

namespace radioslam {

// Pose of a scan by LiDAR odometry, with its covariance and how it was found.

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
  kNewMap,        ///< the first on a new map; the step to it may be of any size
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

/// In pieces: an hour's poses are tens of megabytes, and grow.
using ScanPoses = std::deque<ScanPose>;

Trajectory<SE3> trajectory_of(const ScanPoses& scans);

class LidarOdometry {
 public:
  LidarOdometry(const ScannerTraits& traits, const LidarParams& params);

  /// `T_previous_body`: motion since the last registered scan, if measured otherwise, by `given_by`; without
  /// it a constant velocity is assumed. Its covariance counts after gaps only; zero: not known. Stamps must
  /// increase.
  ScanPose register_scan(Stamp stamp, const LidarScan& scan, const std::optional<SE3>& T_previous_body = {},
                         MotionSource given_by = MotionSource::kOdometry,
                         const SE3::Jacobian& motion_covariance = SE3::Jacobian::Zero());

 private:
  struct Prediction {
    SE3 T_map_body;
    SE3::Tangent twist_per_s;
  };

  Prediction predict(Stamp stamp, const std::optional<SE3>& T_previous_body) const;
  Registration register_at_prediction(const ScanPyramid& cloud, const PosePrior& prior) const;
  /// The best registration from other poses, if it is clearly better than `near`. `is_measured`: whether
  /// something else measured the motion.
  Registration relocalised(const ScanPyramid& cloud, const PosePrior& prior, const Registration& near,
                           bool is_measured) const;

  void start_map(const DeskewedScan& scan, ScanPose& result);
  /// Starts a new map, at the end of this motion if it is known, else at the last pose with a covariance for
  /// travel during the gap and any heading.
  void start_map_after_gap(const DeskewedScan& scan, const std::optional<UncertainPose<SE3>>& motion,
                           ScanPose& result);
  /// How far the robot may be from where it is expected after a gap: by the covariance of its motion or, if
  /// nothing measured it, at its mean speed or its last if that is higher.
  double motion_in_gap_m(Stamp stamp, const std::optional<UncertainPose<SE3>>& measured) const;
  /// Accepts a registered scan; deskews and inserts it.
  void add_to_map(MatchedScan matched, const PosePrior& prior, ScanPose& result);
  /// Adds a lost scan to the candidate map, which replaces the map once it holds enough scans.
  void add_to_candidate(const DeskewedScan& scan, ScanPose& result);
  void promote_candidate(const CandidateMap::Fit& on_candidate, ScanPose& result);
  void advance(const ScanOnMap& place);

  ScanMatcher matcher_;
  LocalMap map_;
  PredictionError error_;
  StructureGate structure_;
  ScanGapDetector gaps_;
  std::optional<ScanOnMap> last_;
  std::optional<Stamp> start_;
  double travelled_m_ = 0;
  SE3::Tangent twist_per_s_ = SE3::Tangent::Zero();
  std::optional<DeskewedScan> first_;  ///< set while it is the map's only scan
  std::optional<CandidateMap> candidate_;
};

}  // namespace radioslam
