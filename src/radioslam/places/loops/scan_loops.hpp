// Intra-robot loop closures by scan matching.
//
//   candidates   pairs of keyframes, far apart along the trajectory, whose distance less `sigmas` standard
//                deviations of their RELATIVE position is below a radius. The covariance admits pairs after
//                a long drift, which a plain distance would miss, and excludes hopeless ones
//   search       the later scan is registered to a submap around the earlier keyframe, from initial poses all
//                over the uncertainty (pose_search.hpp)
//   tests        against other poses and places that explain the scan as well (loop_verification.hpp)
//   estimate     graduated optimization of the robot's pose graph rejects closures that contradict others;
//                the smaller covariances lead to new candidates in the next round, and to another trial of
//                those that were doubtful
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/lidar/local_map.hpp"
#include "radioslam/lidar/pose_search.hpp"
#include "radioslam/places/loops/loop_candidates.hpp"
#include "radioslam/places/loops/scan_loop.hpp"
#include "radioslam/places/scan_context_index.hpp"

namespace radioslam {

struct ScanLoops {
  std::vector<ScanLoop> loops;  ///< all candidates that were tried
  std::vector<SE3> poses;       ///< of the keyframes, optimized with the accepted closures
  TriedPairs tried = {};
  std::size_t registrations = 0;  ///< of this search
  bool has_left_out = false;      ///< candidates, for want of registrations
};

/// How loops are searched. The descriptors' range, where it is 0, is chosen from the robot's scans.
struct ScanLoopSearch {
  ScanLoopParams loops;
  LocalMapParams map;
  PoseSearchParams pose;
  RegistrationParams registration;
  PlaceDescriptorParams descriptors;
  Storeys storeys = Storeys::kSeveral;  ///< that the robot may change between
  /// Largest number of registrations, of candidates of greatest worth (closure_worth.hpp); the others wait
  /// for another search.
  std::size_t most = std::numeric_limits<std::size_t>::max();
};

/// `before`: the loops of the first of these keyframes, when the robot had no more; what was tried then is
/// tried again only where it is predicted much better now, and what contradicted the others may hold. Null:
/// there are none.
ScanLoops close_scan_loops(const ScanKeyframes& keyframes, const ScanLoopSearch& search,
                           const Progress& progress = {}, const ScanLoops* before = nullptr);

}  // namespace radioslam
