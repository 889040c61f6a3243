// Candidate map of LiDAR odometry: built of scans that fit each other but not the current map.
//
// It starts with a lost scan at its predicted pose. A scan that fits it extends it; one that does not starts
// the next candidate. After enough scans it replaces the current map; the whole predicted motion between the
// two maps may be wrong, and is the uncertainty of the step onto it.
#pragma once

#include <optional>

#include "radioslam/lidar/prediction_error.hpp"
#include "radioslam/lidar/scan_matcher.hpp"

namespace radioslam {

// Deskews scans by the motion that their registration found, and registers them again.
//
// A scan deskewed by a wrong velocity is still registered right in the middle of its sweep. Motion is
// therefore measured from middle to middle; errors between stamps would alternate in sign and never decay.

/// A scan registered to a map.
struct MatchedScan {
  DeskewedScan scan;
  ScanPyramid cloud;
  Registration fit;
};

/// The scan deskewed by its motion since `last` and registered again, or as it is if it has no times or its
/// inlier ratio drops.
MatchedScan deskew_and_match(MatchedScan matched, const LocalMap& map, const ScanOnMap& last,
                             const PosePrior& prior, const ScanMatcher& matcher);

/// The first two scans of a map.
struct MapStart {
  LocalMap map;  ///< holds the first one
  ScanOnMap first;
  ScanPyramid first_cloud;
  MatchedScan next;
};

/// Deskews both by the motion between them, or by the given motion, and registers the second one again;
/// nothing if the first one has no times or the inlier ratio drops. `at`: of the first scan;
/// `travelled_m`: at it.
std::optional<MapStart> deskew_map_start(DeskewedScan first, const ScanOnMap& at, MatchedScan next,
                                         const PosePrior& prior, double travelled_m,
                                         const ScanMatcher& matcher);

class CandidateMap {
 public:
  /// Registration of a scan on the candidate map.
  struct Fit {
    Registration fit;
    PosePrior prior;
    double novelty_ratio;
  };

  /// Starts with a scan at its predicted pose; `last_pose`: of the last scan on the current map.
  CandidateMap(const DeskewedScan& scan, const ScanPyramid& cloud, const SE3& predicted, const SE3& last_pose,
               double travelled_m, const ScanMatcher& matcher);

  /// Registers the next lost scan, predicted at this pose on the current map, and inserts it; nothing if it
  /// does not match. The cloud is replaced if the scan is deskewed again.
  std::optional<Fit> add(const DeskewedScan& scan, ScanPyramid& cloud, const SE3& predicted,
                         const PredictionError& error, double travelled_m, const ScanMatcher& matcher);

  int scans() const { return scans_; }
  /// The last two scans.
  const ScanOnMap& before_last() const { return before_last_; }
  const ScanOnMap& last() const { return last_; }
  /// Of the step from the current map.
  SE3::Jacobian step_covariance(const LidarOdometryParams& params) const;

  LocalMap take_map() && { return std::move(map_); }

 private:
  /// Deskews the first two scans, the second of which is `next`.
  MatchedScan deskew_start(MatchedScan next, const PosePrior& prior, double travelled_m,
                           const ScanMatcher& matcher);

  LocalMap map_;
  DeskewedScan first_;
  ScanOnMap before_last_, last_;
  SE3 predicted_;                   ///< of the last one, on the current map
  double gap_m_ = 0, gap_rad_ = 0;  ///< predicted motion from the current map to the candidate
  int scans_ = 1;
};

}  // namespace radioslam
