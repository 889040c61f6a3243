#include "radioslam/io/graph/team_assembly.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include "radioslam/base/check.hpp"
#include "radioslam/base/units.hpp"
#include "radioslam/graph/pose_ids.hpp"
#include "radioslam/io/graph/repeated_edges.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);
/// Converts an index to seconds, as long as these fit into a stamp.
constexpr std::uint64_t kMaxPlace = 9000000000;

/// Indices of the poses, sorted by robot and index along the trajectory.
std::vector<std::size_t> order_of(const std::vector<PoseIndex>& places) {
  std::map<std::string, std::size_t> ranks;
  std::vector<std::size_t> rank;
  for (const PoseIndex& place : places)
    rank.push_back(ranks.try_emplace(place.robot, ranks.size()).first->second);
  std::vector<std::size_t> order(places.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tie(rank[a], places[a].place) < std::tie(rank[b], places[b].place);
  });
  return order;
}

Stamp stamp_of(const PoseIndex& place) {
  if (place.stamp) return *place.stamp;
  return {static_cast<std::int64_t>(std::min(place.place, kMaxPlace)) * kNanosecondsPerSecond};
}

void note_repeated_edges(std::size_t dropped, std::size_t equal, std::vector<std::string>& notes) {
  if (dropped > 0)
    notes.push_back(std::to_string(dropped) +
                    " edges between robots repeat another one, as its inverse or with other digits: each "
                    "measurement counts once");
  if (equal > 0)
    notes.push_back(std::to_string(equal) +
                    " edges between robots stand a second time in the same file and count twice; remove them "
                    "if they are one measurement");
}

/// An edge between two robots that repeats an earlier one, which counts. Equal lines of one file may be two
/// measurements. Returns the places that the edges had before.
template <class Pose>
std::vector<std::size_t> drop_repeated_edges(const std::vector<PoseIndex>& places,
                                             std::vector<RelativePoseFactor<Pose>>& edges,
                                             std::vector<std::string>& notes) {
  std::multimap<std::pair<PoseId, PoseId>, std::size_t> links;
  std::vector<RelativePoseFactor<Pose>> kept;
  std::vector<std::size_t> before;
  std::size_t equal = 0;
  for (std::size_t f = 0; f < edges.size(); ++f) {
    const auto& edge = edges[f];
    if (places[edge.i.index()].robot != places[edge.j.index()].robot) {
      const std::pair<PoseId, PoseId> ends = std::minmax({edge.i, edge.j});
      const auto [begin, end] = links.equal_range(ends);
      auto repeated = begin;
      while (repeated != end && !are_repeated_edges(kept[repeated->second], edge)) ++repeated;
      const bool is_equal = repeated != end && are_equal_edges(kept[repeated->second], edge);
      equal += is_equal ? 1 : 0;
      if (repeated != end && !is_equal) continue;
      links.emplace(ends, kept.size());
    }
    kept.push_back(edge);
    before.push_back(f);
  }
  note_repeated_edges(edges.size() - kept.size(), equal, notes);
  edges = std::move(kept);
  return before;
}

template <class Pose>
class Assembly {
 public:
  Assembly(PoseGraph<Pose> graph, const std::vector<PoseIndex>& places, StatedStarts starts)
      : graph_(std::move(graph)), places_(places), order_(order_of(places)) {
    if (starts == StatedStarts::kIgnored) drop_priors_on_several_robots();
    file_edge_ = drop_repeated_edges(places_, graph_.relative_poses, notes_);
  }

  AssembledTeam<Pose> run() {
    rename_poses();
    choose_odometry();
    cut_into_segments();
    sort_relative_poses();
    for (TrajectorySegment& segment : team_.segments) reckon(segment);
    place_points();
    team_.graph = std::move(graph_);
    TeamGraphFile<Pose> file;
    file.team = std::move(team_);
    file.notes = std::move(notes_);
    return {std::move(file), std::move(order_), std::move(relative_pose_index_)};
  }

 private:
  const PoseIndex& place(std::size_t pose) const { return places_[order_[pose]]; }

  void drop_priors_on_several_robots() {
    std::set<std::string> robots;
    for (const auto& prior : graph_.pose_priors) robots.insert(places_[prior.i.index()].robot);
    if (robots.size() < 2) return;
    notes_.push_back("the priors on poses of " + std::to_string(robots.size()) +
                     " robots are not used: starts count as unknown without --known-starts");
    graph_.pose_priors.clear();
  }

  void rename_poses() {
    std::vector<std::size_t> renamed(order_.size());
    for (std::size_t k = 0; k < order_.size(); ++k) renamed[order_[k]] = k;
    for_each_pose_id(graph_, [&](PoseId& id) { id = PoseId(renamed[id.index()]); });
    graph_.poses.assign(order_.size(), Pose());
    graph_.points.assign(graph_.points.size(), Pose::Point::Zero());
    graph_.pose_fixed.clear();
  }

  /// Whether the factor leads from a pose to its robot's next one.
  bool leads_on(PoseId from, PoseId to) const {
    return to.value == from.value + 1 && place(from.index()).robot == place(to.index()).robot;
  }

  void choose_odometry() {
    odometry_.assign(order_.size(), kNone);
    for (std::size_t f = 0; f < graph_.relative_poses.size(); ++f) {
      auto& factor = graph_.relative_poses[f];
      const bool backward = leads_on(factor.j, factor.i);
      if (!backward && !leads_on(factor.i, factor.j)) continue;
      std::size_t& chosen = odometry_[backward ? factor.j.index() : factor.i.index()];
      if (chosen != kNone) continue;
      chosen = f;
      if (backward) factor = reversed(factor);
    }
  }

  void cut_into_segments() {
    for (std::size_t pose = 0; pose < order_.size(); ++pose) {
      const bool goes_on = pose > 0 && odometry_[pose - 1] != kNone;
      if (!goes_on) {
        team_.segments.emplace_back();
        team_.segments.back().robot = place(pose).robot;
        team_.segments.back().first_pose = pose;
      }
      const bool same_robot = pose > 0 && place(pose - 1).robot == place(pose).robot;
      Stamp stamp = stamp_of(place(pose));
      if (same_robot) stamp.ns = std::max(stamp.ns, last_stamp_.ns + 1);
      last_stamp_ = stamp;
      ++team_.segments.back().pose_count;
      team_.segments.back().stamps.push_back(stamp);
    }
  }

  void sort_relative_poses() {
    std::vector<RelativePoseFactor<Pose>> sorted;
    std::vector<bool> taken(graph_.relative_poses.size(), false);
    for (std::size_t& factor : odometry_) {
      if (factor == kNone) continue;
      taken[factor] = true;
      relative_pose_index_.push_back(factor);
      factor = relative_pose_index_.size() - 1;
    }
    for (std::size_t f = 0; f < taken.size(); ++f)
      if (!taken[f]) relative_pose_index_.push_back(f);
    for (const std::size_t f : relative_pose_index_) sorted.push_back(graph_.relative_poses[f]);
    graph_.relative_poses = std::move(sorted);
    for (std::size_t& f : relative_pose_index_) f = file_edge_[f];
  }

  void reckon(TrajectorySegment& segment) {
    const std::size_t begin = segment.first_pose, end = begin + segment.pose_count;
    for (std::size_t pose = begin + 1; pose < end; ++pose)
      graph_.poses[pose] = graph_.poses[pose - 1] * graph_.relative_poses[odometry_[pose - 1]].T_i_j;
    const auto prior =
        std::find_if(graph_.pose_priors.begin(), graph_.pose_priors.end(),
                     [&](const auto& factor) { return factor.i.index() >= begin && factor.i.index() < end; });
    if (prior == graph_.pose_priors.end()) return;
    segment.in_common_frame = true;
    move_segment(graph_.poses, segment, prior->prior * graph_.poses[prior->i.index()].inverse());
  }

  void place_points() {
    for (auto factor = graph_.positions.rbegin(); factor != graph_.positions.rend(); ++factor)
      if (!factor->i.pose.valid()) graph_.points[factor->i.point.index()] = factor->position;
  }

  PoseGraph<Pose> graph_;
  const std::vector<PoseIndex>& places_;
  std::vector<std::size_t> order_;
  std::vector<std::size_t> odometry_;   // per pose: the factor to the next pose, or kNone
  std::vector<std::size_t> file_edge_;  // per relative pose that counts, its index in the file
  std::vector<std::size_t> relative_pose_index_;
  std::vector<std::string> notes_;
  Stamp last_stamp_;
  TeamGraph<Pose> team_;
};

}  // namespace

template <class Pose>
AssembledTeam<Pose> assemble_team(PoseGraph<Pose> graph, const std::vector<PoseIndex>& places,
                                  StatedStarts starts) {
  RADIOSLAM_CHECK(places.size() == graph.poses.size() && !first_backward_stamp(places),
                  "one place per pose, in the order of time");
  return Assembly<Pose>(std::move(graph), places, starts).run();
}

std::optional<std::size_t> first_backward_stamp(const std::vector<PoseIndex>& places) {
  const auto order = order_of(places);
  for (std::size_t k = 1; k < order.size(); ++k) {
    const PoseIndex& before = places[order[k - 1]];
    const PoseIndex& after = places[order[k]];
    if (before.robot == after.robot && stamp_of(after) < stamp_of(before)) return order[k];
  }
  return std::nullopt;
}

template AssembledTeam<SE2> assemble_team(PoseGraph<SE2>, const std::vector<PoseIndex>&, StatedStarts);
template AssembledTeam<SE3> assemble_team(PoseGraph<SE3>, const std::vector<PoseIndex>&, StatedStarts);

}  // namespace radioslam
