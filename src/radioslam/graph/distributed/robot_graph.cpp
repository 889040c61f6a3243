#include "radioslam/graph/distributed/robot_graph.hpp"

#include <algorithm>
#include <map>

#include "radioslam/base/check.hpp"
#include "radioslam/graph/gauge.hpp"

namespace radioslam {
namespace {

/// The graphs of all robots while they are being filled.
template <class Pose>
class TeamSplit {
 public:
  TeamSplit(const PoseGraph<Pose>& graph, const TeamPoses& team)
      : graph_(graph), team_(team), index_(graph.poses.size()), robots_(team.poses.size()) {
    for (std::size_t r = 0; r < robots_.size(); ++r) {
      robots_[r].robot = static_cast<RobotNumber>(r);
      robots_[r].own_poses = team.poses[r].size();
      robots_[r].graph.chart = graph.chart;
      for (std::size_t k = 0; k < team.poses[r].size(); ++k) {
        index_[team.poses[r][k]] = static_cast<std::uint32_t>(k);
        robots_[r].graph.poses.push_back(graph.poses[team.poses[r][k]]);
      }
    }
  }

  std::vector<RobotGraph<Pose>> run() {
    for (const auto& f : graph_.relative_poses)
      if (robot(f.i) == robot(f.j)) {
        auto& own = robots_[robot(f.i)].graph.relative_poses.emplace_back(f);
        own.i = own_id(f.i);
        own.j = own_id(f.j);
      }
    for (auto& r : robots_) r.own_relative_poses = r.graph.relative_poses.size();
    for (const auto& prior : graph_.pose_priors) add_about_one(prior, &PoseGraph<Pose>::pose_priors);
    list_copies();
    for (const auto& f : graph_.relative_poses)
      if (robot(f.i) != robot(f.j)) {
        add_between(robots_[robot(f.i)], f);
        add_between(robots_[robot(f.j)], f);
      }
    for (auto& r : robots_) number_parts(r);
    return std::move(robots_);
  }

 private:
  RobotNumber robot(PoseId pose) const { return team_.robot_of[pose.index()]; }
  PoseId own_id(PoseId pose) const { return PoseId(static_cast<std::size_t>(index_[pose.index()])); }

  template <class Factor>
  void add_about_one(const Factor& factor, std::vector<Factor> PoseGraph<Pose>::*list) {
    auto& added = (robots_[robot(factor.i)].graph.*list).emplace_back(factor);
    added.i = own_id(factor.i);
  }

  void list_copies() {
    std::vector<std::map<PoseKey, std::vector<std::uint32_t>>> seen(robots_.size());  // and by which own pose
    const auto see = [&](PoseId own, PoseId other) {
      seen[robot(own)][{robot(other), index_[other.index()]}].push_back(index_[own.index()]);
    };
    for (const auto& f : graph_.relative_poses)
      if (robot(f.i) != robot(f.j)) {
        see(f.i, f.j);
        see(f.j, f.i);
      }
    for (auto& r : robots_)
      for (const auto& [key, by] : seen[r.robot]) {
        if (r.neighbours.empty() || r.neighbours.back().robot != key.robot)
          r.neighbours.push_back({key.robot, {}, {}, {}});
        NeighbourRobot& neighbour = r.neighbours.back();
        neighbour.copies.push_back(static_cast<std::uint32_t>(r.graph.poses.size()));
        neighbour.seen.insert(neighbour.seen.end(), by.begin(), by.end());
        r.copies.push_back(key);
        r.graph.poses.emplace_back();
      }
    for (auto& r : robots_)
      for (NeighbourRobot& neighbour : r.neighbours) {
        std::sort(neighbour.seen.begin(), neighbour.seen.end());
        neighbour.seen.erase(std::unique(neighbour.seen.begin(), neighbour.seen.end()), neighbour.seen.end());
      }
  }

  void add_between(RobotGraph<Pose>& to, const RelativePoseFactor<Pose>& factor) {
    const auto local = [&](PoseId pose) {
      if (robot(pose) == to.robot) return own_id(pose);
      const PoseKey key{robot(pose), index_[pose.index()]};
      const auto at = std::lower_bound(to.copies.begin(), to.copies.end(), key);
      return PoseId(to.own_poses + static_cast<std::size_t>(at - to.copies.begin()));
    };
    auto& added = to.graph.relative_poses.emplace_back(factor);
    added.i = local(factor.i);
    added.j = local(factor.j);
    const RobotNumber other = robot(factor.i) == to.robot ? robot(factor.j) : robot(factor.i);
    to.neighbours[neighbour_index(to, other)].between.push_back(
        static_cast<std::uint32_t>(to.graph.relative_poses.size() - 1));
  }

  /// Those that others see come first, so that the lowest robot's part 0 is one that a frame can spread from.
  static void number_parts(RobotGraph<Pose>& robot) {
    const auto components = connected_components(own_graph(robot));
    std::vector<std::uint32_t> seen;
    for (const NeighbourRobot& neighbour : robot.neighbours)
      seen.insert(seen.end(), neighbour.seen.begin(), neighbour.seen.end());
    std::sort(seen.begin(), seen.end());
    std::map<std::int32_t, std::uint32_t> number;
    for (const std::uint32_t pose : seen)
      number.try_emplace(components.of_pose[pose], static_cast<std::uint32_t>(number.size()));
    for (const auto first : components.of_pose)
      robot.part_of.push_back(
          number.try_emplace(first, static_cast<std::uint32_t>(number.size())).first->second);
    robot.parts = number.size();
  }

  const PoseGraph<Pose>& graph_;
  const TeamPoses& team_;
  std::vector<std::uint32_t> index_;  ///< per pose of the team, its number along its robot's trajectory
  std::vector<RobotGraph<Pose>> robots_;
};

}  // namespace

template <class Pose>
std::size_t neighbour_index(const RobotGraph<Pose>& robot, RobotNumber number) {
  const auto at =
      std::lower_bound(robot.neighbours.begin(), robot.neighbours.end(), number,
                       [](const NeighbourRobot& neighbour, RobotNumber n) { return neighbour.robot < n; });
  const bool found = at != robot.neighbours.end() && at->robot == number;
  return found ? static_cast<std::size_t>(at - robot.neighbours.begin()) : robot.neighbours.size();
}

template <class Pose>
PoseGraph<Pose> own_graph(const RobotGraph<Pose>& robot) {
  PoseGraph<Pose> own = robot.graph;
  own.poses.resize(robot.own_poses);
  own.relative_poses.resize(robot.own_relative_poses);
  return own;
}

TeamPoses team_poses(const std::vector<RobotNumber>& robot_of_pose, std::size_t robots) {
  TeamPoses team{robot_of_pose, std::vector<std::vector<std::size_t>>(robots)};
  for (std::size_t p = 0; p < robot_of_pose.size(); ++p) team.poses[robot_of_pose[p]].push_back(p);
  return team;
}

template <class Pose>
std::vector<RobotGraph<Pose>> split_by_robot(const PoseGraph<Pose>& graph, const TeamPoses& team) {
  RADIOSLAM_CHECK(graph.ranges.empty() && graph.bearings.empty() && graph.relative_points.empty() &&
                      graph.positions.empty() && graph.drifts.empty() && graph.range_biases.empty(),
                  "a team's graph that is split has relative poses and priors on poses only");
  return TeamSplit<Pose>(graph, team).run();
}

#define RADIOSLAM_ROBOT_GRAPH(Pose)                                           \
  template std::size_t neighbour_index(const RobotGraph<Pose>&, RobotNumber); \
  template PoseGraph<Pose> own_graph(const RobotGraph<Pose>&);                \
  template std::vector<RobotGraph<Pose>> split_by_robot(const PoseGraph<Pose>&, const TeamPoses&);
RADIOSLAM_ROBOT_GRAPH(SE2)
RADIOSLAM_ROBOT_GRAPH(SE3)
#undef RADIOSLAM_ROBOT_GRAPH

}  // namespace radioslam
