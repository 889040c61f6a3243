#include "radioslam/team_frame/radio_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "radioslam/base/parallel.hpp"
#include "radioslam/graph/marginals.hpp"
#include "radioslam/team_frame/compressed_team.hpp"
#include "radioslam/team_frame/fewer_links.hpp"
#include "radioslam/team_frame/level_priors.hpp"

namespace radioslam {
namespace {

constexpr int kAlone = -1;
constexpr std::size_t kLeastLinksOfPiece = 3;  // x, y and heading
constexpr std::size_t kLeastLinksOfPoint = 2;

/// A team as far as it is placed.
template <class Pose>
struct Team {
  std::vector<Pose> poses;
  std::vector<typename Pose::Point> points;
  std::vector<Drift> drifts;
  double log_evidence = 0;

  void take(const PoseGraph<Pose>& graph) {
    poses = graph.poses;
    points = graph.points;
    drifts = graph.drifts;
  }
  void give(PoseGraph<Pose>& graph) const {
    graph.poses = poses;
    graph.points = points;
    graph.drifts = drifts;
  }
};

SE2 as_pose(const SE2& T, const SE2*) { return T; }
SE3 as_pose(const SE2& T, const SE3*) { return lift(T); }

template <class Pose>
class Builder {
 public:
  Builder(const TeamGraph<Pose>& team, const RadioAlignmentParams& params, const Progress& progress)
      : team_(team), params_(params), progress_(progress) {
    components_.of_piece.assign(team.pieces.size(), kAlone);
    components_.of_point.assign(team.graph.points.size(), kAlone);
    Team<Pose> start;
    start.take(team.graph);
    beam_.push_back(std::move(start));
  }

  void run() {
    int component = 0;
    if (take_known_starts(component)) grow(component++);
    while (const auto root = next_root()) {
      components_.of_piece[*root] = component;
      adopt_sighted_points(component);
      grow(component++);
    }
    for (int& c : components_.of_piece)
      if (c == kAlone) c = component++;
    refine_whole();
    renumber();
  }

  const TeamComponents& components() const { return components_; }
  const std::vector<Team<Pose>>& beam() const { return beam_; }

 private:
  bool take_known_starts(int component) {
    bool any = false;
    for (std::size_t p = 0; p < team_.pieces.size(); ++p)
      if (team_.pieces[p].in_common_frame) components_.of_piece[p] = component, any = true;
    if (!any) return false;
    adopt_sighted_points(component);
    refine_beam();
    return true;
  }

  /// Of the pieces without a component, the one with the strongest link to another such piece (or to a point
  /// that nobody placed); nothing when none has enough links.
  std::optional<std::size_t> next_root() const {
    std::optional<std::size_t> best;
    std::size_t most = 0;
    for (std::size_t p = 0; p < team_.pieces.size(); ++p) {
      if (components_.of_piece[p] != kAlone) continue;
      TeamComponents probe = components_;
      const int alone = static_cast<int>(team_.pieces.size()) + 1;
      probe.of_piece[p] = alone;
      for (const Unit& unit : open_units()) {
        if (unit.is_piece && unit.index == p) continue;
        const std::size_t links = count_links(team_, probe, alone, unit);
        if (links < least_links(unit) || links <= most) continue;
        most = links;
        best = p;
      }
    }
    return best;
  }

  static std::size_t least_links(const Unit& unit) {
    return unit.is_piece ? kLeastLinksOfPiece : kLeastLinksOfPoint;
  }

  std::vector<Unit> open_units() const {
    std::vector<Unit> units;
    for (std::size_t p = 0; p < team_.pieces.size(); ++p)
      if (components_.of_piece[p] == kAlone) units.push_back({true, p});
    for (std::size_t p = 0; p < team_.graph.points.size(); ++p)
      if (components_.of_point[p] == kAlone) units.push_back({false, p});
    return units;
  }

  void grow(int component) {
    while (const auto unit = next_unit(component)) {
      add(component, *unit);
      if (unit->is_piece) adopt_sighted_points(component);
    }
  }

  /// Pieces before points; the one with the most links first.
  std::optional<Unit> next_unit(int component) const {
    std::optional<Unit> best;
    std::size_t most = 0;
    for (const Unit& unit : open_units()) {
      if (best && best->is_piece && !unit.is_piece) break;
      const std::size_t links = count_links(team_, components_, component, unit);
      if (links < least_links(unit) || links <= most) continue;
      most = links;
      best = unit;
    }
    return best;
  }

  /// Points that a placed pose saw stand where it saw them first.
  void adopt_sighted_points(int component) {
    const auto piece_of = piece_of_poses(team_);
    for (const auto& sighting : team_.graph.relative_points) {
      if (sighting.j.pose.valid()) continue;
      int& of_point = components_.of_point[sighting.j.point.index()];
      if (of_point != kAlone || components_.of_piece[piece_of[sighting.i.index()]] != component) continue;
      of_point = component;
      for (Team<Pose>& team : beam_)
        team.points[sighting.j.point.index()] = team.poses[sighting.i.index()] * sighting.position;
    }
  }

  /// The tied measurements as a mixture, at a team's values.
  MixtureGraph<Pose> mixture(const TiedTeam<Pose>& tied, const Team<Pose>& team) const {
    MixtureGraph<Pose> result(tied.team, params_.mixture);
    team.give(result.graph);
    turn_level_priors(result.graph);
    hold_unplaced(result.graph);
    return result;
  }

  /// Pieces that have no component yet take no part.
  void hold_unplaced(PoseGraph<Pose>& graph) const {
    graph.pose_fixed.assign(graph.poses.size(), false);
    for (std::size_t p = 0; p < team_.pieces.size(); ++p)
      if (components_.of_piece[p] == kAlone)
        std::fill_n(graph.pose_fixed.begin() + static_cast<std::ptrdiff_t>(team_.pieces[p].first_pose),
                    team_.pieces[p].pose_count, true);
  }

  static Inflation of_tied(const Inflation& all, const TiedTeam<Pose>& tied) {
    Inflation own;
    for (const std::size_t k : tied.ranges) own.ranges_m2.push_back(all.ranges_m2[k]);
    for (const std::size_t k : tied.bearings) own.bearings_rad2.push_back(all.bearings_rad2[k]);
    return own;
  }

  void move_unit(Team<Pose>& team, const Unit& unit, const SE2& T_team_unit) const {
    const Pose T = as_pose(T_team_unit, static_cast<const Pose*>(nullptr));
    if (!unit.is_piece) {
      team.points[unit.index] = T * team.points[unit.index];
      return;
    }
    move_piece(team.poses, team_.pieces[unit.index], T);
  }

  /// Where the unit may be for every team of the beam: the best places, none twice.
  std::vector<std::pair<std::size_t, Place>> all_places(int component, const Unit& unit) const {
    std::vector<std::pair<std::size_t, Place>> all;
    const TiedTeam<Pose> tied = tied_team(team_, components_);
    for (std::size_t b = 0; b < beam_.size(); ++b) {
      MixtureGraph<Pose> weighted = mixture(tied, beam_[b]);
      weighted.reweigh({}, 0);
      auto places =
          propose_places(team_, components_, component, unit, weighted.graph, params_.mixture, params_.grid);
      if (places.size() > static_cast<std::size_t>(params_.beam.tried_places))
        places.resize(static_cast<std::size_t>(params_.beam.tried_places));
      for (Place& place : places) all.emplace_back(b, std::move(place));
    }
    return all;
  }

  /// A team to refine, and how well it fits so far.
  struct Start {
    Team<Pose> team;
    Inflation inflation;
    double cost = 0;
  };

  /// The best of those that are not close to a better one.
  std::vector<Start> different_starts(std::vector<Start> starts) const {
    std::stable_sort(starts.begin(), starts.end(),
                     [](const auto& a, const auto& b) { return a.cost < b.cost; });
    const std::vector<double> no_sigmas(team_.graph.poses.size(), 0);
    std::vector<Start> kept;
    for (Start& start : starts) {
      if (kept.size() == static_cast<std::size_t>(params_.beam.refined_places)) break;
      if (std::none_of(kept.begin(), kept.end(),
                       [&](const Start& k) { return same(k.team, start.team, no_sigmas); }))
        kept.push_back(std::move(start));
    }
    return kept;
  }

  void add(int component, const Unit& unit) {
    const auto places = all_places(component, unit);
    (unit.is_piece ? components_.of_piece : components_.of_point)[unit.index] = component;
    const TiedTeam<Pose> tied = tied_team(team_, components_);
    std::vector<Start> starts(places.size());
    parallel_for(places.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        starts[k] = {beam_[places[k].first], of_tied(places[k].second.inflation, tied), 0};
        move_unit(starts[k].team, unit, places[k].second.T_team_unit);
        MixtureGraph<Pose> work = mixture(tied, starts[k].team);
        starts[k].cost = refine_coarsely(work, starts[k].inflation, params_.refinement);
        starts[k].team.take(work.graph);
      }
    });
    starts = different_starts(std::move(starts));
    std::vector<Team<Pose>> teams(starts.size());
    parallel_for(starts.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        MixtureGraph<Pose> work = mixture(tied, starts[k].team);
        const Refinement refined = refine(work, starts[k].inflation, params_.refinement);
        teams[k].take(work.graph);
        teams[k].log_evidence = refined.log_evidence;
      }
    });
    keep_best(std::move(teams));
    report_progress(progress_, "team frame",
                    static_cast<double>(unit.index + 1) / static_cast<double>(team_.pieces.size()));
  }

  /// Standard deviation of every pose's position; zero where it cannot be told.
  std::vector<double> position_sigmas(const Team<Pose>& team) const {
    MixtureGraph<Pose> weighted = mixture(tied_team(team_, components_), team);
    weighted.reweigh({}, 0);
    std::vector<double> sigmas(team.poses.size(), 0);
    const auto marginals = Marginals<Pose>::compute(weighted.graph);
    if (!marginals) return sigmas;
    for (std::size_t k = 0; k < sigmas.size(); ++k)
      sigmas[k] =
          std::sqrt(marginals->pose(PoseId(k)).template topLeftCorner<Pose::kDim, Pose::kDim>().trace());
    return sigmas;
  }

  /// Nowhere further apart than what is uncertain anyway; both have the same gauge.
  bool same(const Team<Pose>& a, const Team<Pose>& b, const std::vector<double>& sigmas) const {
    for (std::size_t k = 0; k < a.poses.size(); ++k)
      if ((a.poses[k].translation() - b.poses[k].translation()).norm() >
          params_.beam.same_map_m + params_.beam.same_map_sigmas * sigmas[k])
        return false;
    return true;
  }

  /// `components_` is already that of the teams.
  void keep_best(std::vector<Team<Pose>> teams) {
    std::stable_sort(teams.begin(), teams.end(),
                     [](const auto& a, const auto& b) { return a.log_evidence > b.log_evidence; });
    std::vector<Team<Pose>> kept;
    std::vector<std::vector<double>> sigmas;
    for (Team<Pose>& team : teams) {
      if (kept.size() == static_cast<std::size_t>(params_.beam.beam)) break;
      bool known = false;
      for (std::size_t k = 0; k < kept.size() && !known; ++k) known = same(kept[k], team, sigmas[k]);
      if (known) continue;
      sigmas.push_back(position_sigmas(team));
      kept.push_back(std::move(team));
    }
    if (!kept.empty()) beam_ = std::move(kept);
  }

  void refine_beam() {
    const TiedTeam<Pose> tied = tied_team(team_, components_);
    std::vector<Team<Pose>> teams = beam_;
    for (Team<Pose>& team : teams) {
      MixtureGraph<Pose> work = mixture(tied, team);
      team.log_evidence = refine(work, {}, params_.refinement).log_evidence;
      team.take(work.graph);
    }
    keep_best(std::move(teams));
  }
  void refine_whole() { refine_beam(); }

  /// Component numbers in the order of their first pieces.
  void renumber() {
    std::vector<int> order;
    const auto number = [&](int c) {
      if (c == kAlone) return kAlone;
      const auto found = std::find(order.begin(), order.end(), c);
      if (found != order.end()) return static_cast<int>(found - order.begin());
      order.push_back(c);
      return static_cast<int>(order.size()) - 1;
    };
    for (int& c : components_.of_piece) c = number(c);
    for (int& c : components_.of_point) c = number(c);
  }

  const TeamGraph<Pose>& team_;
  const RadioAlignmentParams& params_;
  const Progress& progress_;
  TeamComponents components_;
  std::vector<Team<Pose>> beam_;
};

/// The team's values in the full graph, refined there once more.
template <class Pose>
TeamHypothesis<Pose> hypothesis(const TeamGraph<Pose>& full, CompressedTeam<Pose>& compressed,
                                const TeamComponents& components, const Team<Pose>& team,
                                const RadioAlignmentParams& params) {
  TeamGraph<Pose> values = full;
  team.give(compressed.team.graph);
  expand_values(compressed, values);
  const TiedTeam<Pose> tied = tied_team(values, components);
  MixtureGraph<Pose> mixture(tied.team, params.mixture);
  turn_level_priors(mixture.graph);
  TeamHypothesis<Pose> result;
  result.log_evidence = refine(mixture, {}, params.refinement).log_evidence;
  result.range_weight.assign(full.graph.ranges.size(), 0);
  for (std::size_t k = 0; k < tied.ranges.size(); ++k)
    result.range_weight[tied.ranges[k]] = mixture.graph.ranges[k].weight;
  for (const auto& bearing : full.bearings) {
    result.path_weight.emplace_back(bearing.paths.size(), 0.0);
    std::vector<double>& sigmas = result.path_sigma_rad.emplace_back();
    for (const auto& path : bearing.paths) sigmas.push_back(path.sigma_rad);
  }
  for (std::size_t k = 0; k < tied.bearings.size(); ++k)
    for (std::size_t p = 0; p < result.path_weight[tied.bearings[k]].size(); ++p) {
      const auto& factor = mixture.graph.bearings[mixture.first_path(k) + p];
      result.path_weight[tied.bearings[k]][p] = factor.weight;
      result.path_sigma_rad[tied.bearings[k]][p] = factor.sigma_rad;
    }
  result.poses = std::move(mixture.graph.poses);
  result.points = std::move(mixture.graph.points);
  result.drifts = std::move(mixture.graph.drifts);
  return result;
}

/// Sorts by evidence and sets the weights.
template <class Pose>
void weigh(std::vector<TeamHypothesis<Pose>>& hypotheses, double overconfidence) {
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const auto& a, const auto& b) { return a.log_evidence > b.log_evidence; });
  const double best = hypotheses.front().log_evidence;
  double sum = 0;
  for (auto& h : hypotheses) {
    h.weight = std::isfinite(best) ? std::exp((h.log_evidence - best) / overconfidence) : 1;
    sum += h.weight;
  }
  for (auto& h : hypotheses) h.weight /= sum;
}

}  // namespace

template <class Pose>
RadioAlignment<Pose> align_by_radio(const TeamGraph<Pose>& team, const RadioAlignmentParams& params,
                                    const Progress& progress) {
  CompressedTeam<Pose> compressed = compress(with_fewer_links(team, params.grid));
  Builder<Pose> builder(compressed.team, params, progress);
  builder.run();
  RadioAlignment<Pose> result;
  result.components = builder.components();
  for (const Team<Pose>& kept : builder.beam())
    result.hypotheses.push_back(hypothesis(team, compressed, result.components, kept, params));
  weigh(result.hypotheses, params.beam.overconfidence);
  return result;
}

template RadioAlignment<SE2> align_by_radio(const TeamGraph<SE2>&, const RadioAlignmentParams&,
                                            const Progress&);
template RadioAlignment<SE3> align_by_radio(const TeamGraph<SE3>&, const RadioAlignmentParams&,
                                            const Progress&);

}  // namespace radioslam
