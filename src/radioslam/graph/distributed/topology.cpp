#include "radioslam/graph/distributed/topology.hpp"

#include <algorithm>

namespace radioslam {

TopologyGossip::TopologyGossip(RobotNumber self, std::vector<RobotNumber> neighbours) {
  for (const RobotNumber n : neighbours) told_[n];
  known_[self] = {self, std::move(neighbours)};
}

void TopologyGossip::hear(RobotNumber from, const std::vector<RobotLinks>& links) {
  for (const RobotLinks& l : links) {
    known_.emplace(l.robot, l);
    if (const auto told = told_.find(from); told != told_.end()) told->second[l.robot] = true;
  }
}

std::vector<RobotLinks> TopologyGossip::news_for(RobotNumber neighbour) {
  std::vector<RobotLinks> news;
  auto& told = told_[neighbour];
  for (const auto& [robot, links] : known_)
    if (told.emplace(robot, true).second) news.push_back(links);
  return news;
}

bool TopologyGossip::complete() const {
  return std::all_of(known_.begin(), known_.end(), [&](const auto& entry) {
    const auto& neighbours = entry.second.neighbours;
    return std::all_of(neighbours.begin(), neighbours.end(), [&](RobotNumber n) { return known_.contains(n); });
  });
}

TeamTree::TeamTree(const std::map<RobotNumber, RobotLinks>& team) {
  std::uint32_t least_depth = ~std::uint32_t{0};
  for (const auto& [candidate, unused] : team) {
    std::map<RobotNumber, Node> nodes{{candidate, {candidate, 0}}};
    std::vector<RobotNumber> queue{candidate};
    for (std::size_t k = 0; k < queue.size(); ++k)
      for (const RobotNumber n : team.at(queue[k]).neighbours)
        if (nodes.emplace(n, Node{queue[k], nodes.at(queue[k]).depth + 1}).second) queue.push_back(n);
    const std::uint32_t depth = nodes.at(queue.back()).depth;
    if (depth >= least_depth) continue;
    least_depth = depth;
    root_ = candidate;
    nodes_ = std::move(nodes);
  }
}

std::vector<RobotNumber> TeamTree::children(RobotNumber robot) const {
  std::vector<RobotNumber> children;
  for (const auto& [child, node] : nodes_)
    if (child != root_ && node.parent == robot) children.push_back(child);
  return children;
}

RobotNumber TeamTree::common_ancestor(RobotNumber a, RobotNumber b) const {
  while (a != b) {
    if (depth(a) < depth(b)) std::swap(a, b);
    a = parent(a);
  }
  return a;
}

}  // namespace radioslam
