// Verifies candidates for intra-robot loop closures by scan matching.
//
// The later scan is searched on a submap around the earlier keyframe, all over the uncertainty of the
// candidate. The closure is accepted if its inlier ratio is close to the nominal one of odometry, no distinct
// pose has a similar one, and it lies within the gate of the estimate.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/lidar/loops/loop_candidates.hpp"
#include "radioslam/lidar/loops/scan_loop.hpp"
#include "radioslam/lidar/pose_search.hpp"

namespace radioslam {

class LoopVerification {
 public:
  /// Keeps a reference to `keyframes`, which must outlive it.
  LoopVerification(const ScanKeyframes& keyframes, const ScanLoopParams& params, const LocalMapParams& map,
                   const PoseSearchParams& search, const RegistrationParams& registration)
      : keyframes_(keyframes),
        params_(params),
        map_params_(map),
        search_(search),
        registration_(registration),
        path_m_(path_lengths(keyframes.poses)) {}

  /// `poses`: current estimate of the keyframes' poses.
  ScanLoop verify(const LoopCandidate& candidate, const std::vector<SE3>& poses) const;

 private:
  LocalMap submap_around(std::size_t i, const std::vector<SE3>& poses) const;
  LoopStatus status_of(const PoseSearch& found, const LoopCandidate& candidate, const ScanLoop& loop) const;
  /// The submap has errors of its own: (I^-1 + minimum covariance)^-1, also for a singular I.
  SE3::Jacobian bounded(const SE3::Jacobian& information) const;

  const ScanKeyframes& keyframes_;
  ScanLoopParams params_;
  LocalMapParams map_params_;
  PoseSearchParams search_;
  RegistrationParams registration_;
  std::vector<double> path_m_;
};

}  // namespace radioslam
