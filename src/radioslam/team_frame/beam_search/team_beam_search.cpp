#include "radioslam/team_frame/beam_search/team_beam_search.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/base/parallel.hpp"
#include "radioslam/team_frame/beam_search/local_placement.hpp"
#include "radioslam/team_frame/beam_search/placement_order.hpp"

namespace radioslam {
namespace {

/// Up to this number of segments the whole team is refined after every one.
constexpr std::size_t kRefinedSegments = 12;
/// Where a unit has fewer links, each of them may be any of its paths, and the beam is wider.
constexpr std::size_t kFewLinks = 7;
constexpr int kWiderBeam = 4;
/// By which parts of a team are off when they are put together.
constexpr double kPartSigma_m = 3, kPartSigma_rad = 0.2;

SE2 as_pose(const PoseProposal& proposal, const SE2*) { return proposal.T_team_unit; }
SE3 as_pose(const PoseProposal& proposal, const SE3*) { return lift(proposal.T_team_unit, proposal.rise_m); }

/// The motion T, in space a translation and a rotation about the vertical, with T * from = to up to tilt.
SE2 level_motion_between(const SE2& from, const SE2& to) { return to * from.inverse(); }
SE3 level_motion_between(const SE3& from, const SE3& to) {
  return lift(level_motion_between(flatten(from), flatten(to)),
              to.translation().z() - from.translation().z());
}

}  // namespace

template <class Pose>
TeamBeamSearch<Pose>::TeamBeamSearch(const TeamGraph<Pose>& team, const RadioAlignmentParams& params,
                                     const Progress& progress)
    : team_(team), params_(params), progress_(progress), width_(params.beam.beam) {
  components_.of_segment.assign(team.segments.size(), kUnplaced);
  components_.of_point.assign(team.graph.points.size(), kUnplaced);
  TeamValues<Pose> start;
  start.read_from(team.graph);
  beam_.push_back(std::move(start));
}

template <class Pose>
void TeamBeamSearch<Pose>::run() {
  int component = 0;
  if (take_known_starts(component)) grow(component++);
  while (const auto root = next_root(team_, components_)) {
    components_.of_segment[*root] = component;
    adopt_sighted_points(component);
    grow(component++);
  }
  for (int& c : components_.of_segment)
    if (c == kUnplaced) c = component++;
  refine_beam();
  renumber(components_);
}

template <class Pose>
bool TeamBeamSearch<Pose>::take_known_starts(int component) {
  bool any = false;
  for (std::size_t p = 0; p < team_.segments.size(); ++p)
    if (team_.segments[p].in_common_frame) components_.of_segment[p] = component, any = true;
  if (!any) return false;
  adopt_sighted_points(component);
  refine_known_starts();
  return true;
}

/// Refines twice: with the variances of drift, without which links late in a long drive pass for outliers,
/// and as the values are.
template <class Pose>
void TeamBeamSearch<Pose>::refine_known_starts() {
  const Connected connected = connected_team(team_, components_);
  TeamGraph<Pose> placed = connected.team;
  beam_.front().write_to(placed.graph);
  keep_best(refined({{beam_.front(), inflation_by_odometry(placed), 0}, {beam_.front(), {}, 0}}, connected));
}

template <class Pose>
void TeamBeamSearch<Pose>::grow(int component) {
  while (const auto unit = next_unit(team_, components_, component)) {
    add(component, *unit);
    if (unit->is_segment) adopt_sighted_points(component);
  }
}

/// Places the points sighted from a placed pose according to their first sighting.
template <class Pose>
void TeamBeamSearch<Pose>::adopt_sighted_points(int component) {
  const auto segment_of = segment_of_poses(team_);
  for (const auto& sighting : team_.graph.relative_points) {
    if (sighting.j.pose.valid()) continue;
    int& of_point = components_.of_point[sighting.j.point.index()];
    if (of_point != kUnplaced || components_.of_segment[segment_of[sighting.i.index()]] != component)
      continue;
    of_point = component;
    for (TeamValues<Pose>& team : beam_)
      team.points[sighting.j.point.index()] = team.poses[sighting.i.index()] * sighting.position;
  }
}

template <class Pose>
void TeamBeamSearch<Pose>::start_from(TeamValues<Pose> values, TeamComponents components) {
  components_ = std::move(components);
  beam_.assign(1, std::move(values));
}

template <class Pose>
std::size_t TeamBeamSearch<Pose>::segments_of(int component) const {
  return static_cast<std::size_t>(
      std::count(components_.of_segment.begin(), components_.of_segment.end(), component));
}

template <class Pose>
void TeamBeamSearch<Pose>::add(int component, const UnplacedNode& unit) {
  const bool is_large = team_.segments.size() > static_cast<std::size_t>(params_.beam.joint_segments);
  const bool is_local =
      is_large && unit.is_segment && team_.graph.points.empty() && segments_of(component) > 1;
  if (is_local)
    add_locally(component, unit.index);
  else
    add_jointly(component, unit);
  report_progress(progress_, "team frame",
                  static_cast<double>(team_.segments.size() - unplaced_nodes(team_, components_).size()) /
                      static_cast<double>(team_.segments.size()));
}

/// Keeps the best of the placements of every team of the beam. They are ranked by the evidence of their
/// parts, then, while that leaves several or the team is small, by that of the whole team.
template <class Pose>
void TeamBeamSearch<Pose>::add_locally(int component, std::size_t segment) {
  std::vector<TeamValues<Pose>> teams;
  for (const TeamValues<Pose>& team : beam_)
    for (TeamValues<Pose>& placed : place_locally(team_, components_, component, segment, team, params_))
      teams.push_back(std::move(placed));
  components_.of_segment[segment] = component;
  if (teams.empty()) return;
  BeamParams wide = params_.beam;
  wide.beam *= 2;
  teams = best_teams(std::move(teams), wide);
  const std::size_t segments = segments_of(component);
  if (teams.size() == 1 && segments > kRefinedSegments && segments < next_refinement_) {
    beam_ = std::move(teams);
    return;
  }
  beam_ = best_teams(refined_gradually(std::move(teams)), params_.beam);
  next_refinement_ = segments * 3 / 2;
}

/// All links start with wide variances: parts that were placed one after the other do not fit together
/// exactly.
template <class Pose>
std::vector<TeamValues<Pose>> TeamBeamSearch<Pose>::refined_gradually(
    std::vector<TeamValues<Pose>> teams) const {
  const Connected connected = connected_team(team_, components_);
  VarianceInflation inflation;
  inflation.ranges_m2.assign(connected.ranges.size(), kPartSigma_m * kPartSigma_m);
  inflation.bearings_rad2.assign(connected.bearings.size(), kPartSigma_rad * kPartSigma_rad);
  Starts starts;
  for (TeamValues<Pose>& team : teams) starts.push_back({std::move(team), inflation, 0});
  return refined(starts, connected);
}

template <class Pose>
void TeamBeamSearch<Pose>::add_jointly(int component, const UnplacedNode& unit) {
  const bool is_open = unit.is_segment && count_links(team_, components_, component, unit) < kFewLinks;
  if (is_open) width_ = kWiderBeam * params_.beam.beam;
  const auto proposals = proposals_for_beam(component, unit);
  (unit.is_segment ? components_.of_segment : components_.of_point)[unit.index] = component;
  const Connected connected = connected_team(team_, components_);
  const Starts starts = different_starts(refined_coarsely(proposals, unit, connected), params_.beam);
  keep_best(refined(starts, connected));
}

/// Start poses of the unit for every team of the beam, as pairs (team, proposal).
template <class Pose>
std::vector<std::pair<std::size_t, PoseProposal>> TeamBeamSearch<Pose>::proposals_for_beam(
    int component, const UnplacedNode& unit) const {
  std::vector<std::pair<std::size_t, PoseProposal>> all;
  const Connected connected = connected_team(team_, components_);
  for (std::size_t b = 0; b < beam_.size(); ++b) {
    MixtureGraph<Pose> weighted = mixture(connected, beam_[b]);
    weighted.estimate_obstructed_share({}, 0);
    weighted.update_weights({}, 0);
    auto places =
        propose_poses(team_, components_, component, unit, weighted.graph, params_.mixture, params_.grid);
    if (places.size() > static_cast<std::size_t>(params_.beam.tried_places))
      places.resize(static_cast<std::size_t>(params_.beam.tried_places));
    for (PoseProposal& place : places) all.emplace_back(b, std::move(place));
  }
  return all;
}

template <class Pose>
typename TeamBeamSearch<Pose>::Starts TeamBeamSearch<Pose>::refined_coarsely(
    const std::vector<std::pair<std::size_t, PoseProposal>>& proposals, const UnplacedNode& unit,
    const Connected& connected) const {
  Starts starts(proposals.size());
  const MixtureGraph<Pose> prototype = mixture(connected, beam_.front());
  parallel_for(proposals.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const auto& [team, proposal] = proposals[k];
      starts[k] = {beam_[team], inflation_of_connected(proposal.inflation, connected), 0};
      move_unit(starts[k].team, unit, proposal);
      return_first_pose(starts[k].team, unit);
      MixtureGraph<Pose> work = prototype;
      starts[k].team.write_to(work.graph);
      starts[k].cost = refine_coarsely(work, starts[k].inflation, params_.refinement);
      starts[k].team.read_from(work.graph);
    }
  });
  return starts;
}

template <class Pose>
std::vector<TeamValues<Pose>> TeamBeamSearch<Pose>::refined(const Starts& starts,
                                                            const Connected& connected) const {
  std::vector<TeamValues<Pose>> teams(starts.size());
  if (starts.empty()) return teams;
  const MixtureGraph<Pose> prototype = mixture(connected, starts.front().team);
  parallel_for(starts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      MixtureGraph<Pose> work = prototype;
      starts[k].team.write_to(work.graph);
      const Refinement refinement = refine(work, starts[k].inflation, params_.refinement);
      teams[k].read_from(work.graph);
      teams[k].log_evidence = refinement.log_evidence;
    }
  });
  return teams;
}

template <class Pose>
void TeamBeamSearch<Pose>::move_unit(TeamValues<Pose>& team, const UnplacedNode& unit,
                                     const PoseProposal& proposal) const {
  const Pose T = as_pose(proposal, static_cast<const Pose*>(nullptr));
  if (!unit.is_segment) {
    team.points[unit.index] = T * team.points[unit.index];
    return;
  }
  move_segment(team.poses, team_.segments[unit.index], T);
}

/// Moves the unit's component rigidly so that its first pose, which holds the frame while it is refined, is
/// where the odometry has it: teams whose first poses differ cannot be compared. Not where priors or
/// positions hold the frame.
template <class Pose>
void TeamBeamSearch<Pose>::return_first_pose(TeamValues<Pose>& team, const UnplacedNode& unit) const {
  if (!team_.graph.positions.empty()) return;
  const bool is_absolute = std::any_of(team_.graph.pose_priors.begin(), team_.graph.pose_priors.end(),
                                       [](const auto& prior) { return !prior.gravity_only; });
  if (is_absolute) return;
  const int component =
      unit.is_segment ? components_.of_segment[unit.index] : components_.of_point[unit.index];
  const auto first = std::find(components_.of_segment.begin(), components_.of_segment.end(), component);
  if (first == components_.of_segment.end()) return;
  const std::size_t pose =
      team_.segments[static_cast<std::size_t>(first - components_.of_segment.begin())].first_pose;
  const Pose T = level_motion_between(team.poses[pose], team_.graph.poses[pose]);
  for (std::size_t p = 0; p < team_.segments.size(); ++p)
    if (components_.of_segment[p] == component) move_segment(team.poses, team_.segments[p], T);
  for (std::size_t p = 0; p < team.points.size(); ++p)
    if (components_.of_point[p] == component) team.points[p] = T * team.points[p];
}

template <class Pose>
MixtureGraph<Pose> TeamBeamSearch<Pose>::mixture(const Connected& connected,
                                                 const TeamValues<Pose>& at) const {
  return partial_mixture(connected, components_, at, params_.mixture);
}

/// `components_` must be those of `teams` already.
template <class Pose>
void TeamBeamSearch<Pose>::keep_best(std::vector<TeamValues<Pose>> teams) {
  BeamParams params = params_.beam;
  params.beam = width_;
  auto kept = different_teams<Pose>(std::move(teams), params, [&](const TeamValues<Pose>& team) {
    return position_sigmas_m(mixture(connected_team(team_, components_), team));
  });
  if (!kept.empty()) beam_ = std::move(kept);
}

template <class Pose>
void TeamBeamSearch<Pose>::refine_beam() {
  const Connected connected = connected_team(team_, components_);
  std::vector<TeamValues<Pose>> teams = beam_;
  for (TeamValues<Pose>& team : teams) {
    MixtureGraph<Pose> work = mixture(connected, team);
    team.log_evidence = refine(work, {}, params_.refinement).log_evidence;
    team.read_from(work.graph);
  }
  keep_best(std::move(teams));
}

template class TeamBeamSearch<SE2>;
template class TeamBeamSearch<SE3>;

}  // namespace radioslam
