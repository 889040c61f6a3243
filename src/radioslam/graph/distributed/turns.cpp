#include "radioslam/graph/distributed/turns.hpp"

#include <algorithm>
#include <set>

namespace radioslam {
namespace {

/// Links between the robot and the one farthest from it.
std::uint32_t eccentricity(const std::map<RobotNumber, RobotLinks>& team, RobotNumber robot) {
  std::map<RobotNumber, std::uint32_t> distance{{robot, 0}};
  std::vector<RobotNumber> queue{robot};
  for (std::size_t k = 0; k < queue.size(); ++k)
    for (const RobotNumber n : team.at(queue[k]).neighbours)
      if (distance.emplace(n, distance.at(queue[k]) + 1).second) queue.push_back(n);
  return distance.at(queue.back());
}

}  // namespace

TurnOrder::TurnOrder(const std::map<RobotNumber, RobotLinks>& team) {
  for (const auto& [robot, links] : team) {
    std::set<std::uint32_t> taken;
    for (const RobotNumber n : links.neighbours)
      if (const auto at = colour_of_.find(n); at != colour_of_.end()) taken.insert(at->second);
    std::uint32_t colour = 0;
    while (taken.contains(colour)) ++colour;
    colour_of_[robot] = colour;
    colours_ = std::max(colours_, colour + 1);
    diameter_ = std::max(diameter_, eccentricity(team, robot));
  }
}

}  // namespace radioslam
