// Selects the team alignments of a beam: the best by cost or evidence, without those that are close to a
// better one.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "radioslam/graph/pose_graph.hpp"
#include "radioslam/team_frame/beam_search/radio_alignment_params.hpp"
#include "radioslam/team_frame/connected_measurements.hpp"
#include "radioslam/team_frame/measurement_mixture.hpp"

namespace radioslam {

// The values of a team's graph, whose segments may be placed only in part, with the evidence for them.

template <class Pose>
struct TeamValues {
  std::vector<Pose> poses;
  std::vector<typename Pose::Point> points;
  std::vector<Drift> drifts;
  double log_evidence = 0;

  void read_from(const PoseGraph<Pose>& graph) {
    poses = graph.poses;
    points = graph.points;
    drifts = graph.drifts;
  }
  void write_to(PoseGraph<Pose>& graph) const {
    graph.poses = poses;
    graph.points = points;
    graph.drifts = drifts;
  }
};

// The mixture likelihood of a team whose segments are placed only in part: measurements within a component,
// at given values, with all other segments fixed.

/// The connected measurements as a mixture, at the values of `at`. Segments without a component are fixed.
template <class Pose>
MixtureGraph<Pose> partial_mixture(const ConnectedTeam<Pose>& connected, const TeamComponents& components,
                                   const TeamValues<Pose>& at, const MixtureParams& params);

/// The inflation of the connected measurements, from that of all measurements of the team.
template <class Pose>
VarianceInflation inflation_of_connected(const VarianceInflation& all, const ConnectedTeam<Pose>& connected);

/// What the odometry's drift adds to the variance of every range and bearing between trajectories in one
/// frame: of positions, and of the receiver's heading, by the team's graph without these. None if no
/// covariance can be computed.
template <class Pose>
VarianceInflation inflation_by_odometry(const TeamGraph<Pose>& team);

/// Standard deviation of every pose's position; zero if no covariance can be computed.
template <class Pose>
std::vector<double> position_sigmas_m(MixtureGraph<Pose> mixture);

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

/// The teams (TeamValues or TeamHypothesis) with the most evidence, at most `beam`, each different from all
/// before within its tolerance and their uncertainty, the standard deviations `position_sigmas_m(team)`.
template <class Pose, template <class> class Team>
std::vector<Team<Pose>> different_teams(std::vector<Team<Pose>> teams, const BeamParams& params,
                                        const auto& position_sigmas_m) {
  if (teams.size() < 2) return teams;
  std::stable_sort(teams.begin(), teams.end(),
                   [](const auto& a, const auto& b) { return a.log_evidence > b.log_evidence; });
  std::vector<Team<Pose>> kept;
  std::vector<std::vector<double>> sigmas_m;
  for (Team<Pose>& team : teams) {
    if (kept.size() == static_cast<std::size_t>(params.beam)) break;
    bool known = false;
    for (std::size_t k = 0; k < kept.size() && !known; ++k)
      known = same_alignment(kept[k].poses, team.poses, sigmas_m[k], params);
    if (known) continue;
    sigmas_m.push_back(position_sigmas_m(team));
    kept.push_back(std::move(team));
  }
  return kept;
}

/// The teams with the most evidence, at most `beam`. Left out are those within `same_map_m` of a better one,
/// which would be refined to the same again and again, and those with a negligible weight beside the best.
template <class Pose>
std::vector<TeamValues<Pose>> best_teams(std::vector<TeamValues<Pose>> teams, const BeamParams& params);

}  // namespace radioslam
