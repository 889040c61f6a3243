#include "radioslam/graph/distributed/topology.hpp"

#include <algorithm>
#include <bit>
#include <iterator>

namespace radioslam {
namespace {

/// Robots by number: a lie about links may make a message mention the same few robots very often.
class RobotSet {
 public:
  /// Whether it was not there yet.
  bool insert(RobotNumber robot) {
    if (robot >= there_.size()) there_.resize(std::size_t{robot} + 1, false);
    const bool is_new = !there_[robot];
    there_[robot] = true;
    return is_new;
  }

 private:
  std::vector<bool> there_;
};

using Bits = std::vector<std::uint64_t>;
constexpr std::size_t kBits = 64;

std::size_t words_for(std::size_t bits) { return (bits + kBits - 1) / kBits; }
void set_bit(Bits& bits, std::size_t place) { bits[place / kBits] |= std::uint64_t{1} << (place % kBits); }

/// Goes from the robots at one distance to those at the next; false where there are none. `next`: room for
/// it.
bool widen(const std::vector<Bits>& linked, Bits& ring, Bits& reached, Bits& next) {
  next.assign(ring.size(), 0);
  for (std::size_t w = 0; w < ring.size(); ++w)
    for (std::uint64_t bits = ring[w]; bits != 0; bits &= bits - 1) {
      const Bits& of = linked[w * kBits + static_cast<std::size_t>(std::countr_zero(bits))];
      for (std::size_t v = 0; v < next.size(); ++v) next[v] |= of[v];
    }
  bool any = false;
  for (std::size_t w = 0; w < ring.size(); ++w) {
    ring[w] = next[w] & ~reached[w];
    reached[w] |= ring[w];
    any = any || ring[w] != 0;
  }
  return any;
}

}  // namespace

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
  RobotSet reached;
  std::vector<RobotNumber> queue{self_};
  reached.insert(self_);
  for (std::size_t k = 0; k < queue.size(); ++k) {
    const auto links = known_.find(queue[k]);
    if (links == known_.end()) return false;
    for (const RobotNumber n : links->second.neighbours)
      if (reached.insert(n)) queue.push_back(n);
  }
  return true;
}

std::map<RobotNumber, RobotLinks> TopologyGossip::reachable() const {
  std::vector<const RobotLinks*> known(std::size_t{known_.rbegin()->first} + 1, nullptr);
  for (const auto& [robot, links] : known_) known[robot] = &links;
  const auto linked = [&](RobotNumber a, RobotNumber b) {
    return a < known.size() && known[a] != nullptr &&
           std::binary_search(known[a]->neighbours.begin(), known[a]->neighbours.end(), b);
  };
  std::map<RobotNumber, RobotLinks> team;
  std::vector<RobotNumber> queue{self_};
  RobotSet reached;
  reached.insert(self_);
  for (std::size_t k = 0; k < queue.size(); ++k) {
    RobotLinks confirmed = *known[queue[k]];
    std::erase_if(confirmed.neighbours, [&](RobotNumber n) { return !linked(n, queue[k]); });
    for (const RobotNumber n : confirmed.neighbours)
      if (reached.insert(n)) queue.push_back(n);
    team.emplace(queue[k], std::move(confirmed));
  }
  return team;
}

std::vector<std::uint32_t> eccentricities(const std::map<RobotNumber, RobotLinks>& team) {
  std::map<RobotNumber, std::size_t> place;
  for (const auto& [robot, unused] : team) place.emplace(robot, place.size());
  std::vector<Bits> linked;
  for (const auto& [robot, links] : team) {
    linked.emplace_back(words_for(team.size()), 0);
    for (const RobotNumber n : links.neighbours) set_bit(linked.back(), place.at(n));
  }
  std::vector<std::uint32_t> eccentricities;
  for (std::size_t from = 0; from < team.size(); ++from) {
    Bits reached(words_for(team.size()), 0), ring, next;
    set_bit(reached, from);
    ring = reached;
    std::uint32_t distance = 0;
    while (widen(linked, ring, reached, next)) ++distance;
    eccentricities.push_back(distance);
  }
  return eccentricities;
}

TeamTree::TeamTree(const std::map<RobotNumber, RobotLinks>& team) {
  id_ = 0xcbf29ce484222325U;  // FNV-1a
  const auto add = [&](std::uint64_t value) { id_ = (id_ ^ value) * 0x100000001b3U; };
  for (const auto& [robot, links] : team) {
    add(robot);
    add(links.version);
    for (const RobotNumber n : links.neighbours) add(n + (std::uint64_t{1} << 32U));
  }
  id_ >>= 2U;  // fits a whole number of the wire
  const std::vector<std::uint32_t> heights = eccentricities(team);
  const auto lowest = std::min_element(heights.begin(), heights.end());
  height_ = *lowest;
  root_ = std::next(team.begin(), lowest - heights.begin())->first;
  nodes_.emplace(root_, Node{root_, 0});
  std::vector<RobotNumber> queue{root_};
  for (std::size_t k = 0; k < queue.size(); ++k)
    for (const RobotNumber n : team.at(queue[k]).neighbours)
      if (nodes_.emplace(n, Node{queue[k], nodes_.at(queue[k]).depth + 1}).second) queue.push_back(n);
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
