#include "radioslam/team_frame/alignment_continuity.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "radioslam/team_frame/beam_search/beam_selection.hpp"

namespace radioslam {
namespace {

constexpr double kClearlyLikelier = 20;
constexpr double kSame_m = 1, kTurn_rad = 0.02, kSigmas = 3;  // between alignments that are the same

template <class Pose>
double evidence_within(const TeamGraph<Pose>& team, const TeamHypothesis<Pose>& hypothesis,
                       const TeamComponents& components, const RadioAlignmentParams& params) {
  TeamGraph<Pose> at = team;
  at.graph.poses = hypothesis.poses;
  return refine_alignment(at, components, params).log_evidence;
}

/// The best alignment of `before`, in its frames, and those found. `log_ratio`: how much likelier the best
/// one found is.
template <class Pose>
RadioAlignment<Pose> beside(const RadioAlignment<Pose>& before, RadioAlignment<Pose> found,
                            double log_ratio) {
  RadioAlignment<Pose> both{before.components, {before.hypotheses.front()}};
  both.hypotheses.front().weight = found.hypotheses.front().weight * std::exp(-std::max(0.0, log_ratio));
  double sum = both.hypotheses.front().weight;
  for (TeamHypothesis<Pose>& other : found.hypotheses) {
    other.weight *= std::exp(std::min(0.0, log_ratio));
    sum += other.weight;
    both.hypotheses.push_back(std::move(other));
  }
  for (TeamHypothesis<Pose>& hypothesis : both.hypotheses) hypothesis.weight /= sum;
  return both;
}

}  // namespace

template <class Pose>
bool agree(const std::vector<Pose>& a, const std::vector<Pose>& b,
           const std::vector<TrajectorySegment>& segments, const std::vector<int>& frame_of_segment,
           const std::vector<double>& sigmas_m) {
  std::map<int, std::size_t> longest;  // by frame
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const auto [known, is_new] = longest.emplace(frame_of_segment[s], s);
    if (!is_new && segments[s].pose_count > segments[known->second].pose_count) known->second = s;
  }
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const TrajectorySegment& segment = segments[s];
    const TrajectorySegment& reference = segments[longest.at(frame_of_segment[s])];
    if (frame_of_segment[s] < 0 || &segment == &reference) continue;
    const std::size_t middle = reference.first_pose + reference.pose_count / 2;
    const Pose T_a_b = a[middle] * b[middle].inverse();
    for (std::size_t k = segment.first_pose; k < segment.first_pose + segment.pose_count; ++k) {
      const double away_m = (a[k].translation() - a[middle].translation()).norm();
      const double off_m = ((T_a_b * b[k]).translation() - a[k].translation()).norm();
      const double sigma_m = sigmas_m.empty() ? 0 : sigmas_m[k];
      if (off_m > kSame_m + kTurn_rad * away_m + kSigmas * sigma_m) return false;
    }
  }
  return true;
}

template <class Pose>
RadioAlignment<Pose> continued(const TeamGraph<Pose>& team, RadioAlignment<Pose> found,
                               const RadioAlignment<Pose>& before, const RadioAlignmentParams& params) {
  const std::vector<int>& frames = before.components.of_segment;
  const TeamHypothesis<Pose>& kept = before.hypotheses.front();
  const TeamValues<Pose> values{kept.poses, kept.points, kept.drifts, kept.log_evidence};
  const std::vector<double> sigmas_m = position_sigmas_m(
      partial_mixture(connected_team(team, before.components), before.components, values, params.mixture));
  const auto agrees = [&](const TeamHypothesis<Pose>& other) {
    return agree(kept.poses, other.poses, team.segments, frames, sigmas_m);
  };
  auto& hypotheses = found.hypotheses;
  if (agrees(hypotheses.front())) return found;
  const double log_ratio = (evidence_within(team, hypotheses.front(), before.components, params) -
                            evidence_within(team, kept, before.components, params)) /
                           params.beam.evidence_temperature;
  if (log_ratio > std::log(kClearlyLikelier)) return found;
  const auto agreeing = std::find_if(hypotheses.begin(), hypotheses.end(), agrees);
  if (agreeing == hypotheses.end()) return beside(before, std::move(found), log_ratio);
  std::rotate(hypotheses.begin(), agreeing, agreeing + 1);
  return found;
}

#define RADIOSLAM_ALIGNMENT_CONTINUITY(Pose)                                            \
  template bool agree(const std::vector<Pose>&, const std::vector<Pose>&,               \
                      const std::vector<TrajectorySegment>&, const std::vector<int>&,   \
                      const std::vector<double>&);                                      \
  template RadioAlignment<Pose> continued(const TeamGraph<Pose>&, RadioAlignment<Pose>, \
                                          const RadioAlignment<Pose>&, const RadioAlignmentParams&);
RADIOSLAM_ALIGNMENT_CONTINUITY(SE2)
RADIOSLAM_ALIGNMENT_CONTINUITY(SE3)
#undef RADIOSLAM_ALIGNMENT_CONTINUITY

}  // namespace radioslam
