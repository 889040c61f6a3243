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

#include <optional>
#include <vector>

#include "radioslam/consistency/consistency_params.hpp"
#include "radioslam/joint/closures/own_loops.hpp"
#include "radioslam/joint/links/radio_covariance.hpp"

namespace radioslam {

// Groups of loops between two trajectories that agree with one another (pairwise consistency, the largest
// sets): each group is one relative pose of the two frames, true or an alias, and at most one per pair is
// true. Evidence counts sightings: loops whose ends are near each other along both trajectories see the same
// place and are wrong together, so a place that looks like another gives many loops and one sighting. A
// sighting of m loops counts 2 m / (m + 1).
// With unit weights (consistency_params.hpp) a pair has one group, the largest set, of two loops at least.

struct LoopGroupParams {
  double sighting_m = 10;        ///< path length within which two loops see the same place
  double sighting_ratio = 0.05;  ///< the same, at most, relative to the length of the shorter trajectory
  std::size_t max_groups = 6;    ///< per pair of segments
  ConsistencyParams consistency;
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

/// A choice of frames.
struct LoopAlignment {
  std::vector<int> component;      ///< per segment
  std::vector<bool> group_holds;   ///< per group: it agrees with these frames
  std::vector<std::size_t> joins;  ///< groups that joined components, a tree per component
  double log_weight = 0;
};

/// The best choices, best first, at least one. `component`: per segment, those with the same number share the
/// frame that the joint graph's poses are in, known exactly or, with `radio`, to its covariance.
template <class Pose>
std::vector<LoopAlignment> align_by_loops(const JointGraph<Pose>& joint, const std::vector<int>& component,
                                          const std::vector<TeamLoop<Pose>>& loops,
                                          const std::vector<LoopGroup>& groups,
                                          const SegmentChains<Pose>& chains,
                                          const std::optional<RadioCovariance<Pose>>& radio = {});

/// Motion T of segment `moved`, one of the loop's, after which the loop holds: poses <- T * poses.
template <class Pose>
Pose motion_to_hold(const std::vector<Pose>& poses, const TeamLoop<Pose>& loop, std::size_t moved);

/// The poses after these groups have joined components, each by its middle loop. `component`: per segment,
/// before; of two, the one that `stays` is not moved.
template <class Pose>
std::vector<Pose> joined(const JointGraph<Pose>& joint, std::vector<Pose> poses,
                         const std::vector<TeamLoop<Pose>>& loops, const std::vector<LoopGroup>& groups,
                         const std::vector<std::size_t>& joins, std::vector<int> component,
                         const std::vector<bool>& stays);

// Alignments that contradict the best one, and what it may still claim in face of them.

/// Whether two choices contradict each other: joins of either do not hold in the other.
bool contradict_each_other(const LoopAlignment& a, const LoopAlignment& b);

/// Sightings below which nothing joins two robots' trajectories. The parts of one robot's trajectory on both
/// sides of a gap are joined by a single loop, too.
inline constexpr double kMinSupport = 1.5, kMinOwnSupport = 1;

/// Parts the first alignment where less joins it, or where another puts the parts together in another way
/// with two thirds of the evidence that it contests. `robot_of_segment`: as in JointGraph.
void undo_weak_joins(const std::vector<LoopGroup>& groups, const std::vector<std::size_t>& robot_of_segment,
                     std::vector<LoopAlignment>& alignments);

}  // namespace radioslam
