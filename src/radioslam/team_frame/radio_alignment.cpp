#include "radioslam/team_frame/radio_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "radioslam/team_frame/beam_search/beam_selection.hpp"
#include "radioslam/team_frame/beam_search/team_beam_search.hpp"
#include "radioslam/team_frame/odometry_compression.hpp"

namespace radioslam {
namespace {

/// Values and weights of the connected measurements' mixture, by the team's lists.
template <class Pose>
TeamHypothesis<Pose> described(const TeamGraph<Pose>& team, const ConnectedTeam<Pose>& connected,
                               MixtureGraph<Pose> mixture, double log_evidence) {
  TeamHypothesis<Pose> result;
  result.log_evidence = log_evidence;
  result.range_weight.assign(team.graph.ranges.size(), 0);
  for (std::size_t k = 0; k < connected.ranges.size(); ++k)
    result.range_weight[connected.ranges[k]] = mixture.range_weight(k);
  for (const auto& bearing : team.bearings) {
    result.path_weight.emplace_back(bearing.paths.size(), 0.0);
    std::vector<double>& sigmas = result.path_sigma_rad.emplace_back();
    for (const auto& path : bearing.paths) sigmas.push_back(path.sigma_rad);
  }
  for (std::size_t k = 0; k < connected.bearings.size(); ++k)
    for (std::size_t p = 0; p < result.path_weight[connected.bearings[k]].size(); ++p) {
      const auto& factor = mixture.graph.bearings[mixture.first_path(k) + p];
      result.path_weight[connected.bearings[k]][p] = factor.weight;
      result.path_sigma_rad[connected.bearings[k]][p] = factor.sigma_rad;
    }
  result.poses = std::move(mixture.graph.poses);
  result.points = std::move(mixture.graph.points);
  result.drifts = std::move(mixture.graph.drifts);
  return result;
}

/// The team's values in the full graph, refined there once more.
template <class Pose>
TeamHypothesis<Pose> hypothesis(const TeamGraph<Pose>& full, CompressedTeam<Pose>& compressed,
                                const TeamComponents& components, const TeamValues<Pose>& team,
                                const RadioAlignmentParams& params) {
  TeamGraph<Pose> values = full;
  team.write_to(compressed.team.graph);
  expand_values(compressed, values);
  return refine_alignment(values, components, params);
}

/// Sets the weights of hypotheses that are sorted by evidence.
template <class Pose>
void weigh(std::vector<TeamHypothesis<Pose>>& hypotheses, double evidence_temperature) {
  const double best = hypotheses.front().log_evidence;
  double sum = 0;
  for (auto& h : hypotheses) {
    h.weight = std::isfinite(best) ? std::exp((h.log_evidence - best) / evidence_temperature) : 1;
    sum += h.weight;
  }
  for (auto& h : hypotheses) h.weight /= sum;
}

/// Those that differ, weighed.
template <class Pose>
RadioAlignment<Pose> ranked(const TeamGraph<Pose>& team, const TeamComponents& components,
                            std::vector<TeamHypothesis<Pose>> hypotheses,
                            const RadioAlignmentParams& params) {
  RadioAlignment<Pose> result{components, {}};
  BeamParams all = params.beam;
  all.beam = static_cast<int>(hypotheses.size());
  result.hypotheses =
      different_teams<Pose>(std::move(hypotheses), all, [&](const TeamHypothesis<Pose>& found) {
        const TeamValues<Pose> values{found.poses, found.points, found.drifts, found.log_evidence};
        return position_sigmas_m(
            partial_mixture(connected_team(team, components), components, values, params.mixture));
      });
  weigh(result.hypotheses, params.beam.evidence_temperature);
  return result;
}

}  // namespace

namespace {

template <class Pose>
TeamHypothesis<Pose> refined(const TeamGraph<Pose>& team, const ConnectedTeam<Pose>& connected,
                             const VarianceInflation& inflation, const RadioAlignmentParams& params) {
  MixtureGraph<Pose> mixture(connected.team, params.mixture);
  const double log_evidence = refine(mixture, inflation, params.refinement).log_evidence;
  return described(team, connected, std::move(mixture), log_evidence);
}

}  // namespace

template <class Pose>
TeamHypothesis<Pose> refine_alignment(const TeamGraph<Pose>& team, const TeamComponents& components,
                                      const RadioAlignmentParams& params) {
  return refined(team, connected_team(team, components), {}, params);
}

template <class Pose>
TeamHypothesis<Pose> weigh_links(const TeamGraph<Pose>& team, const TeamComponents& components,
                                 const MixtureParams& params) {
  const ConnectedTeam<Pose> connected = connected_team(team, components);
  MixtureGraph<Pose> mixture(connected.team, params);
  mixture.estimate_obstructed_share({}, 0);
  const double cost = mixture.update_weights({}, 0);
  return described(team, connected, std::move(mixture), -cost / 2);
}

template <class Pose>
RadioAlignment<Pose> align_by_radio(const TeamGraph<Pose>& team, const RadioAlignmentParams& params,
                                    const Progress& progress) {
  CompressedTeam<Pose> compressed = compress(thin_links(team, params.grid));
  TeamBeamSearch<Pose> search(compressed.team, params, progress);
  search.run();
  std::vector<TeamHypothesis<Pose>> hypotheses;
  for (const TeamValues<Pose>& kept : search.beam())
    hypotheses.push_back(hypothesis(team, compressed, search.components(), kept, params));
  // The full graph may bring together what the search took for different teams.
  return ranked(team, search.components(), std::move(hypotheses), params);
}

template <class Pose>
RadioAlignment<Pose> refine_alignments(const TeamGraph<Pose>& team, const TeamComponents& components,
                                       const std::vector<std::vector<Pose>>& starts,
                                       const RadioAlignmentParams& params) {
  std::vector<TeamHypothesis<Pose>> hypotheses;
  TeamGraph<Pose> at = team;
  for (const std::vector<Pose>& poses : starts) {
    at.graph.poses = poses;
    const ConnectedTeam<Pose> connected = connected_team(at, components);
    hypotheses.push_back(refined(at, connected, {}, params));
    hypotheses.push_back(refined(at, connected, inflation_by_odometry(connected.team), params));
  }
  return ranked(team, components, std::move(hypotheses), params);
}

template TeamHypothesis<SE2> refine_alignment(const TeamGraph<SE2>&, const TeamComponents&,
                                              const RadioAlignmentParams&);
template TeamHypothesis<SE3> refine_alignment(const TeamGraph<SE3>&, const TeamComponents&,
                                              const RadioAlignmentParams&);
template TeamHypothesis<SE2> weigh_links(const TeamGraph<SE2>&, const TeamComponents&, const MixtureParams&);
template TeamHypothesis<SE3> weigh_links(const TeamGraph<SE3>&, const TeamComponents&, const MixtureParams&);
template RadioAlignment<SE2> refine_alignments(const TeamGraph<SE2>&, const TeamComponents&,
                                               const std::vector<std::vector<SE2>>&,
                                               const RadioAlignmentParams&);
template RadioAlignment<SE3> refine_alignments(const TeamGraph<SE3>&, const TeamComponents&,
                                               const std::vector<std::vector<SE3>>&,
                                               const RadioAlignmentParams&);
template RadioAlignment<SE2> align_by_radio(const TeamGraph<SE2>&, const RadioAlignmentParams&,
                                            const Progress&);
template RadioAlignment<SE3> align_by_radio(const TeamGraph<SE3>&, const RadioAlignmentParams&,
                                            const Progress&);

}  // namespace radioslam
