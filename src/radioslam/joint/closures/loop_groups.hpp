// Groups of loops between two trajectories that agree with one another (pairwise consistency, the largest
// sets): each group is one relative pose of the two frames, true or an alias, and at most one per pair is
// true. Evidence counts sightings: loops whose ends are near each other along both trajectories see the same
// place and are wrong together, so a place that looks like another gives many loops and one sighting. A
// sighting of m loops counts 2 m / (m + 1).
#pragma once

#include <vector>

#include "radioslam/consistency/pairwise.hpp"
#include "radioslam/joint/closures/own_loops.hpp"

namespace radioslam {

struct LoopGroupParams {
  double sighting_m = 10;        ///< path length within which two loops see the same place
  double sighting_ratio = 0.05;  ///< the same, at most, relative to the length of the shorter trajectory
};

/// Loops of two segments that agree with one another.
struct LoopGroup {
  std::size_t segment_a = 0, segment_b = 0;  ///< a < b
  std::vector<std::size_t> loops;            ///< at least one, in the order of a's poses
  double evidence = 0;                       ///< sightings, weighted

  std::size_t middle() const { return loops[loops.size() / 2]; }
};

template <class Pose>
std::vector<LoopGroup> loop_groups(const JointGraph<Pose>& joint, const std::vector<TeamLoop<Pose>>& loops,
                                   const SegmentChains<Pose>& chains, const LoopGroupParams& params);

/// The loop as seen from segment a, with poses numbered along their segments.
template <class Pose>
RelativePoseMatch<Pose> seen_from(const JointGraph<Pose>& joint, const TeamLoop<Pose>& loop, std::size_t a);

}  // namespace radioslam
