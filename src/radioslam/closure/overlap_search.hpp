// The pairs of poses of different robots whose views could overlap: exactly those that testing every pair
// finds, by walking both robots' trees of pose intervals (overlap_tree.hpp) at once and leaving out, or
// keeping, whole pairs of intervals (overlap_judge.hpp). Source: Wi-Closure III-B, which splits boxes with
// one global bound.
//
// Frame k is that of the robot listed first. Robots that nothing ties together have no pairs to keep.
// Cost: near-linear in poses plus pairs kept where ways cross; n_a n_b when every pair is near.
// The same output for any number of threads: the walk's first levels are opened breadth-first into a fixed
// number of tasks.
#pragma once

#include "radioslam/closure/overlap_joint.hpp"
#include "radioslam/closure/overlap_link.hpp"
#include "radioslam/closure/overlap_params.hpp"

namespace radioslam {

/// Sources: LinkCovariance and JointCovariance of SE2 and SE3; one sensor per robot.
template <OverlapSource Source>
OverlapCandidates search_overlaps(const Source& source, const std::vector<OverlapSensor>& sensors,
                                  const OverlapParams& params);

/// The same by testing every pair.
template <OverlapSource Source>
OverlapCandidates search_overlaps_exhaustively(const Source& source,
                                               const std::vector<OverlapSensor>& sensors,
                                               const OverlapParams& params);

}  // namespace radioslam
