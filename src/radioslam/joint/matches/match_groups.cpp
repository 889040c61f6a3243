#include "radioslam/joint/matches/match_groups.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "radioslam/consistency/maximum_clique.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/joint/segment_odometry.hpp"

namespace radioslam {
namespace {

/// Robots of a mission have one segment each.
template <class Pose>
const TrajectorySegment& segment(const JointGraph<Pose>& joint, RobotIndex robot) {
  return joint.team.segments[robot.index()];
}

using MatchesOfPairs = std::map<std::pair<RobotIndex, RobotIndex>, std::vector<MatchEnds>>;

template <class Pose>
MatchesOfPairs matches_of_pairs(const JointGraph<Pose>& joint, const std::vector<Closure>& matches) {
  MatchesOfPairs pairs;
  for (std::size_t m = 0; m < matches.size(); ++m) {
    const Closure& match = matches[m];
    if (match.robot_i == match.robot_j) continue;
    const ClosureEnds ends = closure_ends(joint, match);
    if (ends.valid()) pairs[std::minmax(match.robot_i, match.robot_j)].push_back({m, ends.i, ends.j});
  }
  return pairs;
}

}  // namespace

template <class Pose>
RelativePoseMatch<Pose> oriented_match(const JointGraph<Pose>& joint, const Closure& match,
                                       const MatchEnds& ends, RobotIndex a) {
  const Pose T_i_j = pose_as<Pose>(match.T_i_j);
  const typename Pose::Jacobian covariance = covariance_of<Pose>(match);
  const std::size_t i = ends.i.index() - segment(joint, match.robot_i).first_pose,
                    j = ends.j.index() - segment(joint, match.robot_j).first_pose;
  if (match.robot_i == a) return {i, j, T_i_j, covariance};
  const typename Pose::Jacobian turn = T_i_j.adjoint();
  return {j, i, T_i_j.inverse(), congruence(turn, covariance)};
}

template <class Pose>
Pose motion_to_match(const std::vector<Pose>& poses, const Closure& match, const MatchEnds& ends,
                     RobotIndex moved) {
  const Pose T_i_j = pose_as<Pose>(match.T_i_j), at_i = poses[ends.i.index()], at_j = poses[ends.j.index()];
  return match.robot_j == moved ? at_i * T_i_j * at_j.inverse() : at_j * T_i_j.inverse() * at_i.inverse();
}

template <class Pose>
std::vector<MatchGroup> consistent_groups(const JointGraph<Pose>& joint, const std::vector<Closure>& matches,
                                          std::size_t max_groups) {
  std::vector<MatchGroup> groups;
  for (const auto& [robots, ends_of_pair] : matches_of_pairs(joint, matches)) {
    const auto [a, b] = robots;
    std::vector<RelativePoseMatch<Pose>> oriented;
    for (const MatchEnds& ends : ends_of_pair)
      oriented.push_back(oriented_match(joint, matches[ends.match], ends, a));
    const PairwiseConsistency pairs = pairwise_consistency(
        odometry_chain(joint, segment(joint, a)), odometry_chain(joint, segment(joint, b)), oriented);
    std::vector<std::size_t> rest(ends_of_pair.size());
    for (std::size_t k = 0; k < rest.size(); ++k) rest[k] = k;
    for (std::size_t g = 0; g < max_groups && !rest.empty(); ++g) {
      MatchGroup group{a, b, {}};
      const MaximumClique clique = maximum_clique(induced_graph(pairs.graph, rest));
      for (const std::size_t member : clique.vertices) group.matches.push_back(ends_of_pair[rest[member]]);
      for (auto it = clique.vertices.rbegin(); it != clique.vertices.rend(); ++it)
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(*it));
      groups.push_back(std::move(group));
    }
  }
  return groups;
}

#define RADIOSLAM_MATCH_GROUPS(Pose)                                                                         \
  template Pose motion_to_match(const std::vector<Pose>&, const Closure&, const MatchEnds&, RobotIndex);     \
  template RelativePoseMatch<Pose> oriented_match(const JointGraph<Pose>&, const Closure&, const MatchEnds&, \
                                                  RobotIndex);                                               \
  template std::vector<MatchGroup> consistent_groups(const JointGraph<Pose>&, const std::vector<Closure>&,   \
                                                     std::size_t);
RADIOSLAM_MATCH_GROUPS(SE2)
RADIOSLAM_MATCH_GROUPS(SE3)
#undef RADIOSLAM_MATCH_GROUPS

}  // namespace radioslam
