// Who shares factors with whom: robots pass on what they hear until everybody knows, and everybody then
// computes the same tree over the team. It is about robots, not about poses: a few bytes a robot.
#pragma once

#include <map>
#include <vector>

#include "radioslam/graph/distributed/message.hpp"

namespace radioslam {

class TopologyGossip {
 public:
  TopologyGossip(RobotNumber self, std::vector<RobotNumber> neighbours);

  void hear(RobotNumber from, const std::vector<RobotLinks>& links);
  /// What a neighbour has not been told yet, and has not said itself; it counts as told from then on.
  std::vector<RobotLinks> news_for(RobotNumber neighbour);
  /// Of every robot that is mentioned it is known whom it is connected to.
  bool complete() const;
  const std::map<RobotNumber, RobotLinks>& known() const { return known_; }

 private:
  std::map<RobotNumber, RobotLinks> known_;
  std::map<RobotNumber, std::map<RobotNumber, bool>> told_;  ///< per neighbour, the robots it knows
};

/// A breadth-first tree over the robots of a team, from the robot with the shortest way to all others.
class TeamTree {
 public:
  explicit TeamTree(const std::map<RobotNumber, RobotLinks>& team);

  RobotNumber root() const { return root_; }
  bool is_root(RobotNumber robot) const { return robot == root_; }
  RobotNumber parent(RobotNumber robot) const { return nodes_.at(robot).parent; }
  std::uint32_t depth(RobotNumber robot) const { return nodes_.at(robot).depth; }
  std::vector<RobotNumber> children(RobotNumber robot) const;
  /// The lowest robot that both are below, or are.
  RobotNumber common_ancestor(RobotNumber a, RobotNumber b) const;
  std::size_t robots() const { return nodes_.size(); }
  RobotNumber lowest() const { return nodes_.begin()->first; }

 private:
  struct Node {
    RobotNumber parent = 0;
    std::uint32_t depth = 0;
  };
  RobotNumber root_ = 0;
  std::map<RobotNumber, Node> nodes_;
};

}  // namespace radioslam
