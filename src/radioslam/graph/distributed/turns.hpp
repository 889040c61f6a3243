// The order in which the robots of a team move, when two that share factors must not move at the same time.
// Everybody computes the same one from the team's links: a greedy colouring by ascending number. In round k
// those of colour k modulo the number of colours move.
#pragma once

#include <map>

#include "radioslam/graph/distributed/message.hpp"

namespace radioslam {

class TurnOrder {
 public:
  /// `team`: of every robot that is mentioned, its links.
  explicit TurnOrder(const std::map<RobotNumber, RobotLinks>& team);

  bool moves(RobotNumber robot, std::uint32_t round) const {
    return round % colours_ == colour_of_.at(robot);
  }
  std::uint32_t colour(RobotNumber robot) const { return colour_of_.at(robot); }
  /// Rounds until everybody has moved.
  std::uint32_t colours() const { return colours_; }
  /// Rounds that news needs from any robot to any other.
  std::uint32_t diameter() const { return diameter_; }

 private:
  std::map<RobotNumber, std::uint32_t> colour_of_;
  std::uint32_t colours_ = 1, diameter_ = 0;
};

}  // namespace radioslam
