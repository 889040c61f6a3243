// Keeps a team's alignment as measurements come: another one replaces it only where its evidence is clearly
// better.
//
// Alignments of a search are held against the one known before, which is refined with the same measurements.
// Evidence compares alignments of the same frames only, so an alignment that has joined more of them is
// refined within the frames known before.
#pragma once

#include <vector>

#include "radioslam/team_frame/radio_alignment.hpp"

namespace radioslam {

/// Whether two alignments agree on trajectories in one frame: no pose is further than a metre, what a turn by
/// a degree does, and three of its `sigmas_m`, which may be empty, from its place, once the frame's longest
/// trajectory lies on itself. Segments without a frame (-1) are left out.
template <class Pose>
bool agree(const std::vector<Pose>& a, const std::vector<Pose>& b,
           const std::vector<TrajectorySegment>& segments, const std::vector<int>& frame_of_segment,
           const std::vector<double>& sigmas_m = {});

/// The alignments found, with one first that agrees with the best of `before`, unless the best one found is
/// more than 20 times as likely within the frames known before. Where none agrees, the best of `before` comes
/// first, in its frames, with those found as alternatives to it: each weighs what the measurements say.
template <class Pose>
RadioAlignment<Pose> continued(const TeamGraph<Pose>& team, RadioAlignment<Pose> found,
                               const RadioAlignment<Pose>& before, const RadioAlignmentParams& params);

}  // namespace radioslam
