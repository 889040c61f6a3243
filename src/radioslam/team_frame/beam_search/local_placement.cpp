#include "radioslam/team_frame/beam_search/local_placement.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "radioslam/team_frame/beam_search/placement_order.hpp"
#include "radioslam/team_frame/beam_search/team_beam_search.hpp"
#include "radioslam/team_frame/odometry_compression.hpp"

namespace radioslam {
namespace {

/// New ids of the poses that are kept.
template <class Pose>
class KeptPoses {
 public:
  explicit KeptPoses(std::size_t poses) : id_(poses) {}
  void set(std::size_t pose, PoseId id) { id_[pose] = id; }

  /// Gives the factor's ends their new ids; false if one is not kept.
  bool renumber(PoseId& pose) const {
    pose = id_[pose.index()];
    return pose.valid();
  }
  bool renumber(RangeEnd<Pose>& end) const { return end.pose.valid() && renumber(end.pose); }

  template <class Factor>
  void copy_pairs(const std::vector<Factor>& from, std::vector<Factor>& to) const {
    for (Factor factor : from)
      if (renumber(factor.i) && renumber(factor.j)) to.push_back(std::move(factor));
  }
  template <class Factor>
  void copy_single(const std::vector<Factor>& from, std::vector<Factor>& to) const {
    for (Factor factor : from)
      if (renumber(factor.i)) to.push_back(std::move(factor));
  }

 private:
  std::vector<PoseId> id_;
};

}  // namespace

template <class Pose>
SubTeam<Pose> sub_team(const TeamGraph<Pose>& whole, std::vector<std::size_t> segments) {
  SubTeam<Pose> part;
  KeptPoses<Pose> kept(whole.graph.poses.size());
  PoseGraph<Pose>& graph = part.team.graph;
  graph.chart = whole.graph.chart;
  for (const std::size_t p : segments) {
    TrajectorySegment segment = whole.segments[p];
    for (std::size_t k = 0; k < segment.pose_count; ++k) {
      kept.set(segment.first_pose + k, PoseId(graph.poses.size()));
      graph.poses.push_back(whole.graph.poses[segment.first_pose + k]);
    }
    segment.first_pose = graph.poses.size() - segment.pose_count;
    part.team.segments.push_back(std::move(segment));
  }
  graph.drifts = whole.graph.drifts;
  graph.drift_priors = whole.graph.drift_priors;
  graph.range_biases = whole.graph.range_biases;
  graph.range_bias_priors = whole.graph.range_bias_priors;
  kept.copy_pairs(whole.graph.relative_poses, graph.relative_poses);
  kept.copy_pairs(whole.graph.ranges, graph.ranges);
  kept.copy_pairs(whole.bearings, part.team.bearings);
  kept.copy_pairs(whole.graph.relative_points, graph.relative_points);
  kept.copy_single(whole.graph.positions, graph.positions);
  kept.copy_single(whole.graph.pose_priors, graph.pose_priors);
  part.segments = std::move(segments);
  return part;
}

template SubTeam<SE2> sub_team(const TeamGraph<SE2>&, std::vector<std::size_t>);
template SubTeam<SE3> sub_team(const TeamGraph<SE3>&, std::vector<std::size_t>);

namespace {

/// A segment of a large team has links with several others, which leave fewer places open than those of a
/// small one.
RadioAlignmentParams with_fewer_starts(RadioAlignmentParams params) {
  params.beam.tried_places = std::max(1, params.beam.tried_places / 3);
  params.beam.refined_places = std::max(params.beam.beam, params.beam.refined_places / 4);
  return params;
}

/// Poses of placed segments that have a link with the segment, by segment.
template <class Pose>
std::map<std::size_t, std::vector<PoseId>> linked_poses(const TeamGraph<Pose>& team,
                                                        const TeamComponents& components, int component,
                                                        std::size_t segment) {
  const auto segment_of = segment_of_poses(team);
  std::map<std::size_t, std::vector<PoseId>> linked;
  const auto add = [&](PoseId i, PoseId j) {
    if (!i.valid() || !j.valid()) return;
    if (segment_of[i.index()] == segment) std::swap(i, j);
    const std::size_t other = segment_of[i.index()];
    if (segment_of[j.index()] == segment && other != segment && components.of_segment[other] == component)
      linked[other].push_back(i);
  };
  for (const auto& range : team.graph.ranges) add(range.i.pose, range.j.pose);
  for (const auto& bearing : team.bearings) add(bearing.i, bearing.j.pose);
  for (const auto& sighting : team.graph.relative_points) add(sighting.i, sighting.j.pose);
  return linked;
}

struct Neighbours {
  std::vector<std::size_t> segments;  ///< ascending
  PoseId reference;                   ///< of the best-linked one, at the middle of its links
};

template <class Pose>
Neighbours neighbours_of(const TeamGraph<Pose>& team, const TeamComponents& components, int component,
                         std::size_t segment, std::size_t most) {
  auto linked = linked_poses(team, components, component, segment);
  std::vector<std::size_t> order;
  for (const auto& [other, poses] : linked) order.push_back(other);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t x, std::size_t y) { return linked[x].size() > linked[y].size(); });
  if (order.size() > most) order.resize(most);
  Neighbours result;
  if (order.empty()) return result;
  auto& poses = linked[order.front()];
  std::sort(poses.begin(), poses.end(), [](PoseId x, PoseId y) { return x.value < y.value; });
  result.reference = poses[poses.size() / 2];
  std::sort(order.begin(), order.end());
  result.segments = std::move(order);
  return result;
}

/// The team with the segment's poses from its part, moved so that the reference pose is where it was.
template <class Pose>
TeamValues<Pose> with_segment(const TeamGraph<Pose>& team, const TeamValues<Pose>& at,
                              const SubTeam<Pose>& part, const TeamGraph<Pose>& placed, std::size_t segment,
                              PoseId reference) {
  const auto pose_in_part = [&](std::size_t whole_pose) {
    for (std::size_t p = 0; p < part.segments.size(); ++p) {
      const TrajectorySegment& own = team.segments[part.segments[p]];
      if (whole_pose >= own.first_pose && whole_pose < own.first_pose + own.pose_count)
        return placed.graph.poses[placed.segments[p].first_pose + whole_pose - own.first_pose];
    }
    return Pose();
  };
  TeamValues<Pose> result = at;
  const Pose T = at.poses[reference.index()] * pose_in_part(reference.index()).inverse();
  const TrajectorySegment& own = team.segments[segment];
  for (std::size_t k = own.first_pose; k < own.first_pose + own.pose_count; ++k)
    result.poses[k] = T * pose_in_part(k);
  return result;
}

}  // namespace

template <class Pose>
std::vector<TeamValues<Pose>> place_locally(const TeamGraph<Pose>& team, const TeamComponents& components,
                                            int component, std::size_t segment, const TeamValues<Pose>& at,
                                            const RadioAlignmentParams& params) {
  const Neighbours neighbours =
      neighbours_of(team, components, component, segment, static_cast<std::size_t>(params.beam.neighbours));
  if (neighbours.segments.empty()) return {};
  std::vector<std::size_t> segments = neighbours.segments;
  segments.insert(std::upper_bound(segments.begin(), segments.end(), segment), segment);
  TeamGraph<Pose> whole = team;
  at.write_to(whole.graph);
  SubTeam<Pose> part = sub_team(whole, segments);
  CompressedTeam<Pose> compressed = compress(part.team);

  UnplacedNode unit;
  TeamComponents placed;
  for (std::size_t p = 0; p < segments.size(); ++p) {
    placed.of_segment.push_back(segments[p] == segment ? kUnplaced : component);
    if (segments[p] == segment) unit.index = p;
  }
  TeamValues<Pose> start;
  start.read_from(compressed.team.graph);
  const Progress quiet;
  const RadioAlignmentParams fewer = with_fewer_starts(params);
  TeamBeamSearch<Pose> search(compressed.team, fewer, quiet);
  search.start_from(std::move(start), std::move(placed));
  search.refine_start();
  const double evidence_without = search.beam().front().log_evidence;
  search.add_jointly(component, unit);

  std::vector<TeamValues<Pose>> teams;
  for (const TeamValues<Pose>& found : search.beam()) {
    TeamGraph<Pose> values = part.team;
    found.write_to(compressed.team.graph);
    expand_values(compressed, values);
    teams.push_back(with_segment(team, at, part, values, segment, neighbours.reference));
    // Where a part leaves a direction open, its evidence says nothing.
    const double gain = found.log_evidence - evidence_without;
    teams.back().log_evidence = at.log_evidence + (std::isfinite(gain) ? gain : 0);
  }
  return teams;
}

#define RADIOSLAM_LOCAL_PLACEMENT(Pose)                                                                    \
  template std::vector<TeamValues<Pose>> place_locally(const TeamGraph<Pose>&, const TeamComponents&, int, \
                                                       std::size_t, const TeamValues<Pose>&,               \
                                                       const RadioAlignmentParams&)
RADIOSLAM_LOCAL_PLACEMENT(SE2);
RADIOSLAM_LOCAL_PLACEMENT(SE3);

}  // namespace radioslam
