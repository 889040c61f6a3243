// Who shares factors with whom: robots pass on what they hear until everybody knows, and everybody then
// computes the same tree over the team. It is about robots, not about poses: a few bytes a robot.
#pragma once

#include <map>
#include <vector>

#include "radioslam/graph/distributed/message.hpp"

namespace radioslam {

class TopologyGossip {
 public:
  template <class Pose>
  explicit TopologyGossip(const RobotGraph<Pose>& robot) : self_(robot.robot) {
    RobotLinks& own = known_[self_];
    own.robot = self_;
    for (const NeighbourRobot& neighbour : robot.neighbours) own.neighbours.push_back(neighbour.robot);
  }

  void hear(RobotNumber from, const std::vector<RobotLinks>& links);
  /// A neighbour that is no longer there, or is again.
  void drop(RobotNumber neighbour);
  void restore(RobotNumber neighbour);
  /// What has not been sent to a neighbour yet, and was not heard from it; it counts as sent from then on.
  std::vector<RobotLinks> news_for(RobotNumber neighbour);
  /// Lest something was lost on the way, everything is sent again.
  void tell_again() { told_.clear(); }
  /// Of every robot that can be reached it is known whom it is connected to.
  bool complete() const;
  /// The robots that can be reached by links that both ends confirm; this one among them.
  std::map<RobotNumber, RobotLinks> reachable() const;

 private:
  RobotNumber self_;
  std::map<RobotNumber, RobotLinks> known_;
  std::map<RobotNumber, std::map<RobotNumber, std::uint32_t>> told_;  ///< per neighbour: 1 + version it knows
};

/// Per robot of a team, in order, the links to the one farthest from it. `team`: of every robot that is
/// mentioned, its links. Cost: a 64th of the cube of the number of robots.
std::vector<std::uint32_t> eccentricities(const std::map<RobotNumber, RobotLinks>& team);

/// A breadth-first tree over the robots of a team, from the robot with the shortest way to all others.
class TeamTree {
 public:
  /// `team`: robots that are all connected, with links that both ends confirm.
  explicit TeamTree(const std::map<RobotNumber, RobotLinks>& team);

  RobotNumber root() const { return root_; }
  bool is_root(RobotNumber robot) const { return robot == root_; }
  RobotNumber parent(RobotNumber robot) const { return nodes_.at(robot).parent; }
  std::uint32_t depth(RobotNumber robot) const { return nodes_.at(robot).depth; }
  std::vector<RobotNumber> children(RobotNumber robot) const;
  /// The lowest robot that both are below, or are.
  RobotNumber common_ancestor(RobotNumber a, RobotNumber b) const;
  /// A number for the team and its links: robots with the same one have the same tree.
  std::uint64_t id() const { return id_; }
  bool is_below(RobotNumber robot, RobotNumber above) const { return common_ancestor(robot, above) == above; }
  /// Depth of the deepest robot.
  std::uint32_t height() const { return height_; }

 private:
  struct Node {
    RobotNumber parent = 0;
    std::uint32_t depth = 0;
  };
  RobotNumber root_ = 0;
  std::uint32_t height_ = 0;
  std::uint64_t id_ = 0;
  std::map<RobotNumber, Node> nodes_;
};

}  // namespace radioslam
