#include "radioslam/joint/closures/loop_groups.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "radioslam/consistency/maximum_clique.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMaxGroups = 6;   // per pair of segments
constexpr std::size_t kMaxLoops = 600;  // per pair of segments, evenly chosen
constexpr double kMaxBranches = 2e5;    // of a search for the largest group

/// Path length of every pose along its segment.
template <class Pose>
std::vector<double> travelled_m(const JointGraph<Pose>& joint) {
  std::vector<double> travelled(joint.team.graph.poses.size(), 0);
  for (const TrajectorySegment& segment : joint.team.segments)
    for (std::size_t k = segment.first_pose + 1; k < segment.first_pose + segment.pose_count; ++k)
      travelled[k] =
          travelled[k - 1] +
          (joint.team.graph.poses[k].translation() - joint.team.graph.poses[k - 1].translation()).norm();
  return travelled;
}

/// Places seen: loops within `sighting_m` of another along both trajectories are one.
template <class Pose>
double evidence_of(const std::vector<TeamLoop<Pose>>& loops, const LoopGroup& group,
                   const std::vector<double>& travelled, double sighting_m) {
  struct Sighting {
    double at_a_m, at_b_m, loops;
  };
  std::vector<Sighting> sightings;
  for (const std::size_t k : group.loops) {
    const bool forward = loops[k].segment_i == group.segment_a;
    const double at_a_m = travelled[(forward ? loops[k].i : loops[k].j).index()],
                 at_b_m = travelled[(forward ? loops[k].j : loops[k].i).index()];
    const auto same = std::find_if(sightings.begin(), sightings.end(), [&](const Sighting& s) {
      return std::abs(s.at_a_m - at_a_m) < sighting_m && std::abs(s.at_b_m - at_b_m) < sighting_m;
    });
    if (same == sightings.end())
      sightings.push_back({at_a_m, at_b_m, 1});
    else
      ++same->loops;
  }
  double evidence = 0;
  for (const Sighting& s : sightings) evidence += 2 * s.loops / (s.loops + 1);
  return evidence;
}

std::vector<std::size_t> evenly_chosen(std::vector<std::size_t> of, std::size_t count) {
  if (of.size() <= count) return of;
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < count; ++k) chosen.push_back(of[k * of.size() / count]);
  return chosen;
}

}  // namespace

template <class Pose>
RelativePoseMatch<Pose> seen_from(const JointGraph<Pose>& joint, const TeamLoop<Pose>& loop, std::size_t a) {
  const auto& segments = joint.team.segments;
  const std::size_t i = loop.i.index() - segments[loop.segment_i].first_pose,
                    j = loop.j.index() - segments[loop.segment_j].first_pose;
  if (loop.segment_i == a) return {i, j, loop.T_i_j, loop.covariance};
  const UncertainPose<Pose> back = UncertainPose<Pose>{loop.T_i_j, loop.covariance}.inverse();
  return {j, i, back.pose, back.covariance};
}

template <class Pose>
std::vector<LoopGroup> loop_groups(const JointGraph<Pose>& joint, const std::vector<TeamLoop<Pose>>& loops,
                                   const SegmentChains<Pose>& chains, const LoopGroupParams& params) {
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> of_pair;
  for (std::size_t k = 0; k < loops.size(); ++k)
    if (!loops[k].is_own()) of_pair[std::minmax(loops[k].segment_i, loops[k].segment_j)].push_back(k);
  const std::vector<double> travelled = travelled_m(joint);
  const auto length_m = [&](std::size_t segment) {
    const TrajectorySegment& of = joint.team.segments[segment];
    return travelled[of.first_pose + of.pose_count - 1];
  };
  std::vector<LoopGroup> groups;
  for (auto& [pair, all] : of_pair) {
    const auto [a, b] = pair;
    std::vector<std::size_t> rest = evenly_chosen(std::move(all), kMaxLoops);
    std::vector<RelativePoseMatch<Pose>> matches;
    for (const std::size_t k : rest) matches.push_back(seen_from(joint, loops[k], a));
    const PairwiseConsistency pairs = pairwise_consistency(*chains[a], *chains[b], matches);
    const std::vector<std::size_t> loop_of_vertex = rest;
    const double sighting_m =
        std::min(params.sighting_m, params.sighting_ratio * std::min(length_m(a), length_m(b)));
    for (std::size_t k = 0; k < rest.size(); ++k) rest[k] = k;
    MaximumCliqueParams clique_params;
    clique_params.max_branches = kMaxBranches;
    for (std::size_t g = 0; g < kMaxGroups && !rest.empty(); ++g) {
      const MaximumClique clique = maximum_clique(induced_graph(pairs.graph, rest), clique_params);
      LoopGroup group{a, b, {}, 0};
      for (const std::size_t member : clique.vertices) group.loops.push_back(loop_of_vertex[rest[member]]);
      for (auto it = clique.vertices.rbegin(); it != clique.vertices.rend(); ++it)
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(*it));
      group.evidence = evidence_of(loops, group, travelled, sighting_m);
      groups.push_back(std::move(group));
    }
  }
  return groups;
}

#define RADIOSLAM_LOOP_GROUPS(Pose)                                                                        \
  template RelativePoseMatch<Pose> seen_from(const JointGraph<Pose>&, const TeamLoop<Pose>&, std::size_t); \
  template std::vector<LoopGroup> loop_groups(const JointGraph<Pose>&, const std::vector<TeamLoop<Pose>>&, \
                                              const SegmentChains<Pose>&, const LoopGroupParams&);
RADIOSLAM_LOOP_GROUPS(SE2)
RADIOSLAM_LOOP_GROUPS(SE3)
#undef RADIOSLAM_LOOP_GROUPS

}  // namespace radioslam
