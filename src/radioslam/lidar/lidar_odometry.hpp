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

#include <optional>

#include "radioslam/lidar/candidate_map.hpp"
#include "radioslam/lidar/prediction_error.hpp"
#include "radioslam/lidar/scan_matcher.hpp"
#include "radioslam/lidar/scan_pose.hpp"
#include "radioslam/lidar/scan_structure.hpp"

namespace radioslam {

class LidarOdometry {
 public:
  LidarOdometry(const ScannerTraits& traits, const LidarParams& params);

  /// `T_previous_body`: motion since the last registered scan, if measured otherwise, by `given_by`; without
  /// it a constant velocity is assumed. Stamps must increase.
  ScanPose register_scan(Stamp stamp, const LidarScan& scan, const std::optional<SE3>& T_previous_body = {},
                         MotionSource given_by = MotionSource::kOdometry);

 private:
  struct Prediction {
    SE3 T_map_body;
    SE3::Tangent twist_per_s;
  };

  Prediction predict(Stamp stamp, const std::optional<SE3>& T_previous_body) const;
  Registration register_at_prediction(const ScanPyramid& cloud, const PosePrior& prior) const;
  /// The best registration from other poses, if it is clearly better than `near`.
  Registration relocalised(const ScanPyramid& cloud, const PosePrior& prior, const Registration& near) const;

  void start_map(const DeskewedScan& scan, ScanPose& result);
  /// Starts a new map at the last pose, with a covariance for travel during the gap and any heading.
  void start_map_after_gap(const DeskewedScan& scan, ScanPose& result);
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
  double travelled_m_ = 0;
  SE3::Tangent twist_per_s_ = SE3::Tangent::Zero();
  std::optional<DeskewedScan> first_;  ///< set while it is the map's only scan
  std::optional<CandidateMap> candidate_;
};

}  // namespace radioslam
