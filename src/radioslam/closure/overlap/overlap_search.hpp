// Overlap search: all pairs of poses of different robots whose views could overlap. The result is exactly
// that of testing every pair, by branch and bound over both robots' trees of pose intervals
// (overlap_tree.hpp), which excludes or accepts whole pairs of intervals (overlap_bounds.hpp). Source:
// Wi-Closure (Wang et al., III-B), which splits boxes with one global bound.
//
// Frame k is that of the robot listed first. Robots without any connection have no candidates. Cost:
// near-linear in poses plus pairs kept for crossing trajectories; n_a n_b if every pair is close. The output
// is independent of the number of threads: the first levels are expanded breadth-first into a fixed number of
// tasks.
#pragma once

#include <functional>
#include <vector>

#include "radioslam/closure/overlap/overlap_joint.hpp"
#include "radioslam/closure/overlap/overlap_link.hpp"
#include "radioslam/closure/overlap/overlap_params.hpp"

namespace radioslam {

/// Receives the candidates of two robots, sorted by their poses; two robots after the other.
using TakeOverlaps = std::function<void(std::vector<OverlapCandidate>)>;

/// `Source`: LinkCovariance or JointCovariance of SE2 or SE3. One sensor per robot. Each pair of robots'
/// candidates are handed over once they are found, so that a large team's are never all in this form.
template <OverlapSource Source>
OverlapCounts search_overlaps(const Source& source, const std::vector<OverlapSensor>& sensors,
                              const OverlapParams& params, const TakeOverlaps& take);
/// The same in one list.
template <OverlapSource Source>
OverlapCandidates search_overlaps(const Source& source, const std::vector<OverlapSensor>& sensors,
                                  const OverlapParams& params);

/// The same results by testing every pair.
template <OverlapSource Source>
OverlapCounts search_overlaps_exhaustively(const Source& source, const std::vector<OverlapSensor>& sensors,
                                           const OverlapParams& params, const TakeOverlaps& take);
template <OverlapSource Source>
OverlapCandidates search_overlaps_exhaustively(const Source& source,
                                               const std::vector<OverlapSensor>& sensors,
                                               const OverlapParams& params);

}  // namespace radioslam
