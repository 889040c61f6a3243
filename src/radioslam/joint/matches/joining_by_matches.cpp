#include "radioslam/joint/matches/joining_by_matches.hpp"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "radioslam/joint/matches/match_groups.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMinMatches = 3;
constexpr std::size_t kMinRatioToSecond = 2;
constexpr std::size_t kGroups = 2;  // the largest and its rival

struct PairOfRobots {
  MatchGroup largest;
  std::size_t second = 0;  ///< size of the second group
  std::size_t matches = 0;

  bool is_clear() const {
    return largest.matches.size() >= kMinMatches && largest.matches.size() >= kMinRatioToSecond * second;
  }
};

template <class Pose>
std::vector<PairOfRobots> pairs_of_robots(const JointGraph<Pose>& joint,
                                          const std::vector<Closure>& matches) {
  std::map<std::pair<RobotIndex, RobotIndex>, PairOfRobots> pairs;
  for (MatchGroup& group : consistent_groups(joint, matches, kGroups)) {
    PairOfRobots& pair = pairs[{group.a, group.b}];
    if (pair.largest.matches.empty())
      pair.largest = std::move(group);
    else
      pair.second = group.matches.size();
  }
  for (const Closure& match : matches) {
    const auto found = pairs.find(std::minmax(match.robot_i, match.robot_j));
    if (found != pairs.end()) ++found->second.matches;
  }
  std::vector<PairOfRobots> result;
  for (auto& [robots, pair] : pairs) result.push_back(std::move(pair));
  std::stable_sort(result.begin(), result.end(), [](const auto& x, const auto& y) {
    return x.largest.matches.size() > y.largest.matches.size();
  });
  return result;
}

/// Moves the component of the group's robot b to where the middle match wants it.
template <class Pose>
void join(JointGraph<Pose>& joint, TeamAlignment<Pose>& alignment, const std::vector<Closure>& matches,
          const MatchGroup& group) {
  // A component in the common frame stays where it is.
  const auto absolute = [&](RobotIndex robot) {
    return static_cast<bool>(
        alignment.absolute[static_cast<std::size_t>(alignment.component[robot.index()])]);
  };
  const RobotIndex moved = absolute(group.b) ? group.a : group.b,
                   fixed = absolute(group.b) ? group.b : group.a;
  const Closure& match = matches[group.middle().match];
  const int from = alignment.component[moved.index()], to = alignment.component[fixed.index()];
  const auto move = [&](std::vector<Pose>& poses) {
    const Pose T = motion_to_match(poses, match, group.middle(), moved);
    for (std::size_t p = 0; p < joint.team.segments.size(); ++p)
      if (alignment.component[joint.robot_of_segment[p]] == from)
        move_segment(poses, joint.team.segments[p], T);
  };
  move(joint.team.graph.poses);
  for (std::vector<Pose>& alternative : alignment.alternatives) move(alternative);
  for (std::size_t r = 0; r < alignment.component.size(); ++r)
    if (alignment.component[r] == from || alignment.component[r] == to) {
      alignment.component[r] = to;
      alignment.placed[r] = true;
    }
}

template <class Pose>
std::string names(const JointGraph<Pose>& joint, const PairOfRobots& pair) {
  return joint.robots[pair.largest.a.index()].id + " and " + joint.robots[pair.largest.b.index()].id;
}

std::string counts(const PairOfRobots& pair) {
  return std::to_string(pair.largest.matches.size()) + " of " + std::to_string(pair.matches) + " matches";
}

template <class Pose>
void renumber(TeamAlignment<Pose>& alignment) {
  const std::vector<bool> before = alignment.absolute;
  const std::vector<int> number = renumber_components(alignment.component);
  alignment.absolute.assign(before.size(), false);
  for (std::size_t c = 0; c < number.size(); ++c)
    if (number[c] >= 0) alignment.absolute[static_cast<std::size_t>(number[c])] = before[c];
}

}  // namespace

template <class Pose>
void join_by_matches(JointGraph<Pose>& joint, TeamAlignment<Pose>& alignment,
                     const std::vector<Closure>& matches) {
  const auto& component = alignment.component;
  if (std::all_of(component.begin(), component.end(), [&](int c) { return c == component.front(); })) return;
  const auto share_frame = [&](const PairOfRobots& pair) {
    return component[pair.largest.a.index()] == component[pair.largest.b.index()];
  };
  const auto both_absolute = [&](const PairOfRobots& pair) {
    return alignment.absolute[static_cast<std::size_t>(component[pair.largest.a.index()])] &&
           alignment.absolute[static_cast<std::size_t>(component[pair.largest.b.index()])];
  };
  const std::vector<PairOfRobots> pairs = pairs_of_robots(joint, matches);
  bool is_joined = false;
  for (const PairOfRobots& pair : pairs) {
    if (!pair.is_clear() || share_frame(pair) || both_absolute(pair)) continue;
    alignment.notes.push_back("the relative pose of " + names(joint, pair) +
                              " stands on matches alone: " + counts(pair) + " agree with one another");
    join(joint, alignment, matches, pair.largest);
    is_joined = true;
  }
  for (const PairOfRobots& pair : pairs)
    if (!pair.is_clear() && !share_frame(pair) && !both_absolute(pair))
      alignment.notes.push_back("matches leave the relative pose of " + names(joint, pair) +
                                " open: the largest group that agrees has " + counts(pair) + ", the second " +
                                std::to_string(pair.second));
  if (is_joined) renumber(alignment);
}

template void join_by_matches(JointGraph<SE2>&, TeamAlignment<SE2>&, const std::vector<Closure>&);
template void join_by_matches(JointGraph<SE3>&, TeamAlignment<SE3>&, const std::vector<Closure>&);

}  // namespace radioslam
