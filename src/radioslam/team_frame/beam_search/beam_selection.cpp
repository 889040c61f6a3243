#include "radioslam/team_frame/beam_search/beam_selection.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace radioslam {
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
