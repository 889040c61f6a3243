// Alignment of a team by loops between its trajectories.
//
// Loops between two trajectories that agree with one another (pairwise consistency, the largest sets) form
// groups; each group is one relative pose of the two frames, true or an alias, and at most one per pair is
// true. Which are is decided for the whole team: groups are taken strongest first, and each either joins two
// components, confirms the frames they have, or contradicts them; a beam of the best choices is kept. So
// three robots in a cycle decide where a pair cannot. A choice has the weight exp(sum of the evidence of the
// groups that agree with it).
// Evidence: loop_groups.hpp; each count of it multiplies the odds by five.
#pragma once

#include <vector>

#include "radioslam/joint/closures/loop_groups.hpp"

namespace radioslam {

/// A choice of frames: poses <- T * poses of every segment.
template <class Pose>
struct LoopAlignment {
  std::vector<int> component;         ///< per segment
  std::vector<Pose> T_frame_segment;  ///< per segment
  std::vector<bool> group_holds;      ///< per group: it agrees with these frames
  std::vector<std::size_t> joins;     ///< groups that joined components, a tree per component
  double log_weight = 0;
};

/// The best choices, best first, at least one. `component`: per segment, those with the same number share the
/// frame that the joint graph's poses are in.
template <class Pose>
std::vector<LoopAlignment<Pose>> align_by_loops(const JointGraph<Pose>& joint,
                                                const std::vector<int>& component,
                                                const std::vector<TeamLoop<Pose>>& loops,
                                                const std::vector<LoopGroup>& groups,
                                                const SegmentChains<Pose>& chains);

}  // namespace radioslam
