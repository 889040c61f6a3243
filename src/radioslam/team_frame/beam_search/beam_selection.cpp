#include "radioslam/team_frame/beam_search/beam_selection.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "radioslam/graph/marginals.hpp"
#include "radioslam/graph/residuals.hpp"
#include "radioslam/team_frame/beam_search/placement_order.hpp"

namespace radioslam {
namespace {

template <class Pose>
void fix_unplaced(PoseGraph<Pose>& graph, const std::vector<TrajectorySegment>& segments,
                  const TeamComponents& components) {
  graph.pose_fixed.assign(graph.poses.size(), false);
  for (std::size_t p = 0; p < segments.size(); ++p)
    if (components.of_segment[p] == kUnplaced)
      std::fill_n(graph.pose_fixed.begin() + static_cast<std::ptrdiff_t>(segments[p].first_pose),
                  segments[p].pose_count, true);
}

}  // namespace

template <class Pose>
MixtureGraph<Pose> partial_mixture(const ConnectedTeam<Pose>& connected, const TeamComponents& components,
                                   const TeamValues<Pose>& at, const MixtureParams& params) {
  MixtureGraph<Pose> result(connected.team, params);
  at.write_to(result.graph);
  fix_unplaced(result.graph, connected.team.segments, components);
  return result;
}

template <class Pose>
VarianceInflation inflation_of_connected(const VarianceInflation& all, const ConnectedTeam<Pose>& connected) {
  VarianceInflation own;
  for (const std::size_t k : connected.ranges) own.ranges_m2.push_back(all.ranges_m2[k]);
  for (const std::size_t k : connected.bearings) own.bearings_rad2.push_back(all.bearings_rad2[k]);
  return own;
}

template <class Pose>
VarianceInflation inflation_by_odometry(const TeamGraph<Pose>& team) {
  PoseGraph<Pose> odometry = team.graph;
  odometry.ranges.clear();
  const auto marginals = Marginals<Pose>::compute(odometry);
  if (!marginals) return {};
  const auto position_variance = [&](PoseId pose) {
    return pose.valid() ? marginals->pose(pose).template topLeftCorner<Pose::kDim, Pose::kDim>().trace() : 0;
  };
  VarianceInflation inflation;
  for (const auto& range : team.graph.ranges)
    inflation.ranges_m2.push_back(position_variance(range.i.pose) + position_variance(range.j.pose));
  for (const auto& bearing : team.bearings) {
    const double distance = std::max(distance_m(team.graph, bearing), kMinimumDistance_m);
    const double across_m2 = position_variance(bearing.i) + position_variance(bearing.j.pose);
    const double heading = marginals->pose(bearing.i)(Pose::kDof - 1, Pose::kDof - 1);
    inflation.bearings_rad2.push_back(across_m2 / (distance * distance) + heading);
  }
  return inflation;
}

template <class Pose>
std::vector<double> position_sigmas_m(MixtureGraph<Pose> mixture) {
  mixture.estimate_obstructed_share({}, 0);
  mixture.update_weights({}, 0);
  std::vector<double> sigmas_m(mixture.graph.poses.size(), 0);
  const auto marginals = Marginals<Pose>::compute(mixture.graph);
  if (!marginals) return sigmas_m;
  for (std::size_t k = 0; k < sigmas_m.size(); ++k)
    sigmas_m[k] =
        std::sqrt(marginals->pose(PoseId(k)).template topLeftCorner<Pose::kDim, Pose::kDim>().trace());
  return sigmas_m;
}

#define RADIOSLAM_PARTIAL_MIXTURE(Pose)                                                                    \
  template MixtureGraph<Pose> partial_mixture(const ConnectedTeam<Pose>&, const TeamComponents&,           \
                                              const TeamValues<Pose>&, const MixtureParams&);              \
  template VarianceInflation inflation_of_connected(const VarianceInflation&, const ConnectedTeam<Pose>&); \
  template VarianceInflation inflation_by_odometry(const TeamGraph<Pose>&);                                \
  template std::vector<double> position_sigmas_m(MixtureGraph<Pose>)
RADIOSLAM_PARTIAL_MIXTURE(SE2);
RADIOSLAM_PARTIAL_MIXTURE(SE3);

namespace {

constexpr double kNegligible = 12;  // logarithm of the ratio of weights

}  // namespace

template <class Pose>
bool same_alignment(const std::vector<Pose>& a, const std::vector<Pose>& b,
                    const std::vector<double>& sigmas_m, const BeamParams& params) {
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double uncertainty_m = sigmas_m.empty() ? 0 : params.same_map_sigmas * sigmas_m[k];
    if ((a[k].translation() - b[k].translation()).norm() > params.same_map_m + uncertainty_m) return false;
  }
  return true;
}

template <class Pose>
std::vector<RefinementStart<Pose>> different_starts(std::vector<RefinementStart<Pose>> starts,
                                                    const BeamParams& params) {
  std::stable_sort(starts.begin(), starts.end(),
                   [](const auto& a, const auto& b) { return a.cost < b.cost; });
  std::vector<RefinementStart<Pose>> kept;
  for (auto& start : starts) {
    if (kept.size() == static_cast<std::size_t>(params.refined_places)) break;
    if (std::none_of(kept.begin(), kept.end(), [&](const auto& other) {
          return same_alignment(other.team.poses, start.team.poses, {}, params);
        }))
      kept.push_back(std::move(start));
  }
  return kept;
}

template <class Pose>
std::vector<TeamValues<Pose>> best_teams(std::vector<TeamValues<Pose>> teams, const BeamParams& params) {
  teams = different_teams<Pose>(std::move(teams), params, [](const auto&) { return std::vector<double>(); });
  if (teams.empty() || !std::isfinite(teams.front().log_evidence)) return teams;
  const double least = teams.front().log_evidence - kNegligible * params.evidence_temperature;
  std::erase_if(teams, [&](const auto& team) { return !(team.log_evidence >= least); });
  return teams;
}

#define RADIOSLAM_BEAM_SELECTION(Pose)                                                                 \
  template std::vector<TeamValues<Pose>> best_teams(std::vector<TeamValues<Pose>>, const BeamParams&); \
  template bool same_alignment(const std::vector<Pose>&, const std::vector<Pose>&,                     \
                               const std::vector<double>&, const BeamParams&);                         \
  template std::vector<RefinementStart<Pose>> different_starts(std::vector<RefinementStart<Pose>>,     \
                                                               const BeamParams&)
RADIOSLAM_BEAM_SELECTION(SE2);
RADIOSLAM_BEAM_SELECTION(SE3);

}  // namespace radioslam
