// Joint likelihood of the radio's alignments of a team and of groups of consistent matches.
//
// Each group of consistent matches between two robots (match_groups.hpp) is one measurement of their relative
// pose, true or an alias; that its members agree does not show which. Alignments are those of the radio and,
// for groups that contradict the best of them, the one that refinement finds from the group's own relative
// pose. Each alignment h has the weight
//   w_h = exp(E_h / T) prod_pairs (1 + max_G r_G),   r_G = n_G / (n + 4) N(e; 0, T P + S) / u
// with E_h the radio's log evidence, T its temperature, e the planar error (x, y, yaw) of the group's middle
// match under h, P the covariance of the relative pose under h and S the match's own, u the uniform density
// of a relative pose over the area of both trajectories, n_G the number of the group's matches and n that of
// all groups of the pair. So the radio decides between true and false groups whatever their sizes where it
// distinguishes them, and a group outweighs the radio's best alignment where its own explains the radio
// nearly as well.
#pragma once

#include <cstddef>

#include "radioslam/graph/marginals.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/joint/matches/match_groups.hpp"
#include "radioslam/joint/team_alignment.hpp"
#include "radioslam/team_frame/measurement_mixture.hpp"

namespace radioslam {

// Placement by matches alone: joins robots that neither radio links nor fingerprints connect.
//
// The largest group of consistent matches (match_groups.hpp) of a pair of robots is their relative pose if it
// has at least three matches and twice as many as the second group; a smaller one could be an alias.
// Components are joined by their largest such group first, as a spanning tree.

/// Moves the robots of every component that a group joins to another, and notes on what the frame stands and
/// which pairs of robots stay open because no group is large enough.
template <class Pose>
void join_by_matches(JointGraph<Pose>& joint, TeamAlignment<Pose>& alignment,
                     const std::vector<Closure>& matches);

/// Moves the team to the alignment with the largest weight and updates the alignment's weights and
/// alternatives. `joint` must be optimized and placed by radio links; without them, or without matches
/// between robots, nothing changes. Returns whether the team was moved to another alignment; it is then to be
/// optimized.
template <class Pose>
bool choose_alignment_by_matches(JointGraph<Pose>& joint, TeamAlignment<Pose>& alignment,
                                 const std::vector<Closure>& matches, const RadioAlignmentParams& params);

/// Squared Mahalanobis norm of a match under the joint estimate, whose relative poses have the covariances of
/// `marginals` times `temperature`.
template <class Pose>
double match_statistic(const JointGraph<Pose>& joint, const Marginals<Pose>& marginals, double temperature,
                       const Closure& match, const MatchEnds& ends);

}  // namespace radioslam
