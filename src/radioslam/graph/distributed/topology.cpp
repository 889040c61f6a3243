#include "radioslam/graph/distributed/topology.hpp"

#include <algorithm>
#include <set>

namespace radioslam {

void TopologyGossip::hear(RobotNumber from, const std::vector<RobotLinks>& links) {
  for (const RobotLinks& l : links) {
    auto& told = told_[from][l.robot];
    told = std::max(told, l.version + 1);
    if (l.robot == self_) continue;
    const auto known = known_.try_emplace(l.robot, l).first;
    if (l.version > known->second.version) known->second = l;
  }
}

void TopologyGossip::drop(RobotNumber neighbour) {
  RobotLinks& own = known_[self_];
  if (std::erase(own.neighbours, neighbour) > 0) ++own.version;
}

void TopologyGossip::restore(RobotNumber neighbour) {
  RobotLinks& own = known_[self_];
  const auto place = std::lower_bound(own.neighbours.begin(), own.neighbours.end(), neighbour);
  if (place != own.neighbours.end() && *place == neighbour) return;
  own.neighbours.insert(place, neighbour);
  ++own.version;
}

std::vector<RobotLinks> TopologyGossip::news_for(RobotNumber neighbour) {
  std::vector<RobotLinks> news;
  for (const auto& [robot, links] : known_) {
    auto& told = told_[neighbour][robot];
    if (told <= links.version) news.push_back(links);
    told = std::max(told, links.version + 1);
  }
  return news;
}

bool TopologyGossip::complete() const {
  std::set<RobotNumber> reached{self_};
  std::vector<RobotNumber> queue{self_};
  for (std::size_t k = 0; k < queue.size(); ++k) {
    const auto links = known_.find(queue[k]);
    if (links == known_.end()) return false;
    for (const RobotNumber n : links->second.neighbours)
      if (reached.insert(n).second) queue.push_back(n);
  }
  return true;
}

std::map<RobotNumber, RobotLinks> TopologyGossip::reachable() const {
  const auto linked = [&](RobotNumber a, RobotNumber b) {
    const auto links = known_.find(a);
    return links != known_.end() &&
           std::find(links->second.neighbours.begin(), links->second.neighbours.end(), b) !=
               links->second.neighbours.end();
  };
  std::map<RobotNumber, RobotLinks> team;
  std::vector<RobotNumber> queue{self_};
  for (std::size_t k = 0; k < queue.size(); ++k) {
    if (team.contains(queue[k])) continue;
    RobotLinks confirmed = known_.at(queue[k]);
    std::erase_if(confirmed.neighbours, [&](RobotNumber n) { return !linked(n, queue[k]); });
    queue.insert(queue.end(), confirmed.neighbours.begin(), confirmed.neighbours.end());
    team.emplace(queue[k], std::move(confirmed));
  }
  return team;
}

TeamTree::TeamTree(const std::map<RobotNumber, RobotLinks>& team) {
  height_ = ~std::uint32_t{0};
  id_ = 0xcbf29ce484222325U;  // FNV-1a
  const auto add = [&](std::uint64_t value) { id_ = (id_ ^ value) * 0x100000001b3U; };
  for (const auto& [robot, links] : team) {
    add(robot);
    add(links.version);
    for (const RobotNumber n : links.neighbours) add(n + (std::uint64_t{1} << 32U));
  }
  id_ >>= 2U;  // fits a whole number of the wire
  for (const auto& [candidate, unused] : team) {
    std::map<RobotNumber, Node> nodes{{candidate, {candidate, 0}}};
    std::vector<RobotNumber> queue{candidate};
    for (std::size_t k = 0; k < queue.size(); ++k)
      for (const RobotNumber n : team.at(queue[k]).neighbours)
        if (nodes.emplace(n, Node{queue[k], nodes.at(queue[k]).depth + 1}).second) queue.push_back(n);
    const std::uint32_t depth = nodes.at(queue.back()).depth;
    if (depth >= height_) continue;
    height_ = depth;
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
