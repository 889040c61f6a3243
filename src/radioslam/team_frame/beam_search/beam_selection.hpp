// Selects the team alignments of a beam: the best by cost or evidence, without those that are close to a
// better one.
#pragma once

#include <functional>
#include <vector>

#include "radioslam/team_frame/beam_search/radio_alignment_params.hpp"
#include "radioslam/team_frame/beam_search/team_values.hpp"

namespace radioslam {

/// A team to refine, and its cost so far.
template <class Pose>
struct RefinementStart {
  TeamValues<Pose> team;
  VarianceInflation inflation;
  double cost = 0;
};

/// Whether all corresponding poses agree within `same_map_m` and their uncertainty; both teams have the same
/// gauge. `sigmas_m`: standard deviation of every pose's position; empty: none.
template <class Pose>
bool same_alignment(const std::vector<Pose>& a, const std::vector<Pose>& b,
                    const std::vector<double>& sigmas_m, const BeamParams& params);

/// The cheapest starts, at most `refined_places`, each different from all before.
template <class Pose>
std::vector<RefinementStart<Pose>> different_starts(std::vector<RefinementStart<Pose>> starts,
                                                    const BeamParams& params);

/// The teams with the most evidence, at most `beam`; those with a negligible weight beside the best are left
/// out.
template <class Pose>
std::vector<TeamValues<Pose>> best_teams(std::vector<TeamValues<Pose>> teams, const BeamParams& params);

/// The teams with the most evidence, at most `beam`, each different from all before within its tolerance and
/// their uncertainty, the standard deviations `position_sigmas_m(team)`.
template <class Pose>
std::vector<TeamValues<Pose>> different_teams(
    std::vector<TeamValues<Pose>> teams, const BeamParams& params,
    const std::function<std::vector<double>(const TeamValues<Pose>&)>& position_sigmas_m);

}  // namespace radioslam
