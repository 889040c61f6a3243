// A robot's way from its scans: every scan is laid onto the map of those before it.
//
//   points    what of the scan can be used, unbent by the motion so far          (scan_points.hpp)
//   surfels   the points thinned, each with its surface                          (voxel_grid.hpp, surfel.hpp)
//   pose      generalised ICP onto the map, from where the motion leads          (registration.hpp);
//             where that fits worse than usual, from other starts as well        (pose_search.hpp)
//   points    unbent by the motion that was found, and the pose once more, where nothing else told the motion
//   map       takes what it does not have yet, and forgets what is out of sight  (local_map.hpp)
//
// How far points may lie from the map follows from how wrong the predicted motion was so far, as in KISS-ICP
// (Vizzo et al. 2023, "adaptive threshold"); the same deviation is the prior of the pose, so that along a
// direction in which the scans tell nothing the prediction stands, with its uncertainty.
//
// The motion is measured from the middle of one sweep to the middle of the next. A scan unbent by a motion
// that is wrong lies wrong at its stamp, but not at its middle; from stamp to stamp the error would return as
// that of the next motion, with the other sign, and never decay where stamps are the sweeps' beginnings. The
// motion so far is as old as one sweep, so a robot that speeds up or begins to turn has its scans bent, and
// its poses at their stamps wrong by a degree: what was found is put in its place at once. A motion that
// inertial readings or wheels told of the sweep itself is newer than that, and true where scans tell nothing;
// it stays. Of a map's first scan the motion is often not known until the second one is laid onto it; then
// both are unbent, or the whole way would lie off by what the robot went during half a sweep.
//
// A scanner in the plane has its map in that plane, and tells nothing of height, roll and pitch. Its robot
// stays there but for rocking a little (`level_sigma_m`, `level_sigma_rad`): so much is told of its pose.
//
// A scan that does not fit begins a rival map, which the next ones that do not fit either must fit; one that
// does not takes its place. After `patience` scans the rival becomes the map: where it lies is as uncertain
// as the motion from the last scan that did fit. A first scan that the second one does not fit is no map yet:
// one scan that fits the rival is enough. Noise fits anything: a scan without order (scan_order.hpp) neither
// begins a map nor is searched for from afar, unless `patience` others before it had none either.
//
// After a time without scans, `patience` times as long as usual, nothing but scans tells how the robot moved:
// one that fits where it stood as well as usual goes on there; any other begins a new map at once, since
// among all the poses that the robot may have reached by then some fit by chance.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/lidar/lidar_params.hpp"
#include "radioslam/lidar/local_map.hpp"
#include "radioslam/lidar/pose_search.hpp"
#include "radioslam/lidar/registration.hpp"
#include "radioslam/lidar/scan_sweep.hpp"
#include "radioslam/lidar/scanner_traits.hpp"

namespace radioslam {

/// What became of a scan.
enum class ScanOutcome {
  kRegistered,
  kFirst,      ///< where the map starts
  kTooFew,     ///< hardly any points that can be used
  kUnmatched,  ///< does not fit the map
  kNewMap,     ///< registered on a new map: the step to it is hardly known
};

/// Is the scan's pose one of the robot's way?
constexpr bool is_on_the_way(ScanOutcome outcome) {
  return outcome == ScanOutcome::kRegistered || outcome == ScanOutcome::kFirst ||
         outcome == ScanOutcome::kNewMap;
}

/// A scan's pose in the frame of the robot's start.
struct ScanPose {
  Stamp stamp;
  SE3 T_start_body;
  SE3::Jacobian covariance = SE3::Jacobian::Zero();   ///< of the step from the scan registered before
  SE3::Jacobian information = SE3::Jacobian::Zero();  ///< of the pose on the map, from the points alone
  ScanOutcome outcome = ScanOutcome::kTooFew;
  double new_share = 0;  ///< of its points, that entered the map
  double matched_share = 0;
  double rms_m = 0;
  int iterations = 0;
  PointCounts counts;
  ScanCloud cloud;                            ///< in the body frame; empty where there are too few points
  std::optional<ScanCloud> first_cloud = {};  ///< of the scan before, which began the map: unbent since
};

/// Of registered scans.
Trajectory<SE3> trajectory_of(const std::vector<ScanPose>& scans);

class ScanOdometer {
 public:
  ScanOdometer(const ScannerTraits& traits, const LidarParams& params);

  /// `T_previous_body`: the motion since the last scan that was registered, where something else tells it;
  /// otherwise the robot is taken to go on as before. Stamps must increase.
  ScanPose add(Stamp stamp, const LidarScan& scan, const std::optional<SE3>& T_previous_body = {});

 private:
  /// How wrong the predicted motion was so far, mean squares per axis.
  struct Deviation {
    double squares_m2 = 0, squares_rad2 = 0;
    std::size_t count = 0;
  };

  /// What scans that did not fit the map make up.
  struct Rival {
    LocalMap map;
    ScanPlace before, last;  ///< the last two scans' places
    SE3 predicted;           ///< the last one's, from the map
    ScanSweep first;
    double gap_m, gap_rad;  ///< predicted motion from the map to the rival
    int scans = 1;
  };
  /// The first two sweeps of a map, unbent.
  struct MapStart {
    ScanSweep first, next;
    LocalMap map;  ///< of the first one
    ScanCloud first_cloud, next_cloud;
    ScanPlace first_place;
    Registration fit;  ///< of the next one
  };
  struct RivalFit {
    Registration fit;
    PosePrior prior;
    double new_share;
  };

  double sigma_m() const;
  double sigma_rad() const;
  double least_share() const;
  double enough_share() const;
  bool may_be_a_map(const ScanCloud& cloud);
  bool is_after_gap(Stamp stamp);
  SE3::Jacobian told_of_pose(const SE3::Jacobian& information) const;
  PosePrior prior_at(const SE3& predicted) const;
  ScanSweep sweep_of(Stamp stamp, const ScanPoints& points, const SE3::Tangent& twist_per_s,
                     MotionSource source) const;
  ScanCloud cloud_of(const ScanSweep& sweep) const;
  Registration lay_nearby(const ScanCloud& cloud, const PosePrior& prior) const;
  Registration search_afar(const ScanCloud& cloud, const PosePrior& prior, const Registration& near) const;
  Registration unbend(ScanSweep& sweep, ScanCloud& cloud, const Registration& fit,
                      const PosePrior& prior) const;
  std::optional<MapStart> unbend_start(const ScanSweep& first, const ScanPlace& at, const ScanSweep& next,
                                       const Registration& fit, const PosePrior& prior) const;
  void unbend_rival(ScanSweep& sweep, ScanCloud& cloud, Registration& fit, const PosePrior& prior);
  void begin_rival(const ScanSweep& sweep, const ScanCloud& cloud, const SE3& predicted);
  std::optional<RivalFit> lay_onto_rival(ScanSweep sweep, ScanCloud& cloud, const SE3& predicted);
  void begin(const ScanSweep& sweep, ScanPose& result);
  void begin_after_gap(const ScanSweep& sweep, ScanPose& result);
  void try_new_map(const ScanSweep& sweep, ScanPose& result);
  void begin_anew(const RivalFit& on_rival, ScanPose& result);
  void register_on_map(ScanSweep sweep, const Registration& fit, const PosePrior& prior, ScanPose& result);
  void learn(const SE3& deviation, double matched_share);
  void advance(const ScanPlace& place);

  ScannerTraits traits_;
  LidarParams params_;
  LocalMap map_;
  std::optional<ScanPlace> last_;
  double way_m_ = 0;
  SE3::Tangent twist_per_s_ = SE3::Tangent::Zero();
  Deviation deviation_;
  double usual_share_ = 0;          ///< of a scan's points that fit
  std::optional<ScanSweep> first_;  ///< the only one on the map
  std::optional<Rival> rival_;
  std::optional<Stamp> newest_;
  double interval_s_ = 0;  ///< between scans, usually; 0: not known yet
  int without_order_ = 0;  ///< scans in a row that do not fit and have no order
};

}  // namespace radioslam
