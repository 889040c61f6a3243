#include "radioslam/graph/distributed/turns.hpp"

#include <algorithm>
#include <set>

#include "radioslam/graph/distributed/topology.hpp"

namespace radioslam {
TurnOrder::TurnOrder(const std::map<RobotNumber, RobotLinks>& team) {
  for (const auto& [robot, links] : team) {
    std::set<std::uint32_t> taken;
    for (const RobotNumber n : links.neighbours)
      if (const auto at = colour_of_.find(n); at != colour_of_.end()) taken.insert(at->second);
    std::uint32_t colour = 0;
    while (taken.contains(colour)) ++colour;
    colour_of_[robot] = colour;
    colours_ = std::max(colours_, colour + 1);
  }
  const auto farthest = eccentricities(team);
  diameter_ = *std::max_element(farthest.begin(), farthest.end());
}

}  // namespace radioslam
