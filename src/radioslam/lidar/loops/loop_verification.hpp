// Verifies by scan matching that two keyframes, of one robot or of two, saw the same place.
//
// The scan of one is searched on a submap around the other, all over the uncertainty of their predicted
// relative pose. The closure is accepted if its inlier ratio is close to the nominal one of odometry, no
// distinct pose has a similar one, and it lies within the gate of the prediction.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/lidar/loops/scan_loop.hpp"
#include "radioslam/lidar/pose_search.hpp"

namespace radioslam {

/// Path length from the first pose to each.
std::vector<double> path_lengths(const std::vector<SE3>& poses);

/// One robot's keyframes at the poses of an estimate, of which only those near one another matter.
struct PlacedKeyframes {
  const ScanKeyframes& keyframes;
  const std::vector<SE3>& poses;
  const std::vector<double>& path_m;  ///< from the first keyframe to each
};

/// Path lengths to either side of two keyframes whose scans are registered to each other.
struct SubmapExtents {
  double target_m = 0;
  double source_m = 0;  ///< 0: the scan alone
  double apart_m = 0;   ///< path length between scans of a submap; 0: all
};

class LoopVerification {
 public:
  LoopVerification(const ScanLoopParams& params, const SubmapExtents& extents, const LocalMapParams& map,
                   const PoseSearchParams& search, const RegistrationParams& registration)
      : params_(params), extents_(extents), map_params_(map), search_(search), registration_(registration) {}

  /// Keyframe j of `source` on the submap around keyframe i of `target`; `T_i_j`: where it is expected.
  ScanLoop verify(const PlacedKeyframes& target, std::size_t i, const PlacedKeyframes& source, std::size_t j,
                  const UncertainPose<SE3>& T_i_j) const;

 private:
  LocalMap submap_around(const PlacedKeyframes& robot, std::size_t i, double extent_m) const;
  ScanPyramid source_around(const PlacedKeyframes& robot, std::size_t j) const;
  LoopStatus status_of(const PoseSearch& found, const UncertainPose<SE3>& expected, double nominal_ratio,
                       const ScanLoop& loop) const;
  /// The submap has errors of its own: (I^-1 + minimum covariance)^-1, also for a singular I.
  SE3::Jacobian bounded(const SE3::Jacobian& information) const;

  ScanLoopParams params_;
  SubmapExtents extents_;
  LocalMapParams map_params_;
  PoseSearchParams search_;
  RegistrationParams registration_;
};

}  // namespace radioslam
