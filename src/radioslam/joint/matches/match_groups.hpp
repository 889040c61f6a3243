// Groups of matches between two robots that are consistent with one another: each group is one relative pose
// of the robots' odometry frames. At most one group per pair of robots can be true; the others are aliases,
// places that look alike.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/consistency/pairwise.hpp"
#include "radioslam/joint/closures/closure.hpp"

namespace radioslam {

/// Ends of a match in the joint graph.
struct MatchEnds {
  std::size_t match = 0;  ///< index in the list
  PoseId i, j;
};

/// A match of robots a and b as the relative pose of b's end from a's, whichever way it was measured.
template <class Pose>
RelativePoseMatch<Pose> oriented_match(const JointGraph<Pose>& joint, const Closure& match,
                                       const MatchEnds& ends, RobotIndex a);

struct MatchGroup {
  RobotIndex a, b;                 ///< a < b
  std::vector<MatchEnds> matches;  ///< at least one

  /// The match that stands for the group.
  const MatchEnds& middle() const { return matches[matches.size() / 2]; }
};

/// Motion T of robot `moved`, one of the match's, after which the match holds: poses <- T * poses.
template <class Pose>
Pose motion_to_match(const std::vector<Pose>& poses, const Closure& match, const MatchEnds& ends,
                     RobotIndex moved);

/// The largest groups of every pair of robots, largest first, disjoint, at most `max_groups` per pair.
/// Matches at times without odometry belong to none.
template <class Pose>
std::vector<MatchGroup> consistent_groups(const JointGraph<Pose>& joint, const std::vector<Closure>& matches,
                                          std::size_t max_groups);

}  // namespace radioslam
