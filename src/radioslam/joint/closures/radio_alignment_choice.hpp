// Joint likelihood of the radio's alignments of a team and of groups of consistent closures.
//
// Each group of closures between two trajectories that agree (loop_alignment.hpp) is one measurement of their
// relative pose, true or an alias; that its members agree does not show which. Alignments are those of the
// radio and, for groups that contradict the best of them, the one that refinement finds from the group's own
// relative pose. Each alignment h has the weight
//   w_h = exp(E_h / T) prod_pairs (1 + max_G r_G),   r_G = n_G / (n + 4) N(e; 0, T P + S) / u
// with E_h the radio's log evidence, T its temperature, e the planar error (x, y, yaw) of the group's middle
// loop under h, P the covariance of the relative pose under h and S the loop's own, u the uniform density of
// a relative pose over the area of both trajectories, n_G the number of the group's loops and n that of all
// groups of the pair. So the radio decides between true and false groups whatever their sizes where it
// distinguishes them, and a group outweighs the radio's best alignment where its own explains the radio
// nearly as well.
#pragma once

#include <vector>

#include "radioslam/joint/closures/loop_alignment.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/joint/team_alignment.hpp"
#include "radioslam/team_frame/radio_alignment.hpp"

namespace radioslam {

class MapWitness;

/// Moves the team to the alignment with the largest weight and updates the alignment's weights and
/// alternatives. `joint` must be optimized and placed by radio links; without them, or without closures
/// between robots, nothing changes. Returns whether the team was moved to another alignment; it is then to be
/// optimized. `maps`: as in close_by_loops.
template <class Pose>
bool choose_alignment_by_loops(JointGraph<Pose>& joint, TeamAlignment<Pose>& alignment,
                               const std::vector<Closure>& closures, const RadioAlignmentParams& params,
                               const ConsistencyParams& consistency = {}, const MapWitness* maps = nullptr);

}  // namespace radioslam
