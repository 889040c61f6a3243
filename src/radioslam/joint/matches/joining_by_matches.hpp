// Placement by matches alone: joins robots that neither radio links nor fingerprints connect.
//
// The largest group of consistent matches (match_groups.hpp) of a pair of robots is their relative pose if it
// has at least three matches and twice as many as the second group; a smaller one could be an alias.
// Components are joined by their largest such group first, as a spanning tree.
#pragma once

#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/joint/team_alignment.hpp"

namespace radioslam {

/// Moves the robots of every component that a group joins to another, and notes on what the frame stands and
/// which pairs of robots stay open because no group is large enough.
template <class Pose>
void join_by_matches(JointGraph<Pose>& joint, TeamAlignment<Pose>& alignment,
                     const std::vector<Closure>& matches);

}  // namespace radioslam
