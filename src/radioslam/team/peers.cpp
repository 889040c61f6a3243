#include "radioslam/team/peers.hpp"

#include <algorithm>
#include <vector>

namespace radioslam {

void ByteBudget::refill(Stamp now) {
  if (filled_) left_ = std::min(bytes_s_, left_ + bytes_s_ * seconds_between(*filled_, now));
  filled_ = now;
}

std::size_t ByteBudget::at_most(std::size_t bytes) const {
  return bytes_s_ == 0 ? bytes : std::min(bytes, static_cast<std::size_t>(std::max(0.0, left_)));
}

std::map<std::string, LogExtent> Asking::known_by(const std::map<std::string, Peer>& peers,
                                                  const std::string& self, Stamp now) {
  std::map<std::string, LogExtent> most;
  for (const auto& [name, peer] : peers) {
    if (!peer.is_heard(now)) continue;
    for (const auto& [robot, extent] : peer.knows) {
      if (robot == self) continue;
      const auto [known, is_new] = most.emplace(robot, extent);
      const bool is_more =
          std::pair(extent.life, extent.records) > std::pair(known->second.life, known->second.records);
      // What a robot says of its own life counts.
      const auto own = peers.find(robot);
      const bool has_spoken = own != peers.end() && own->second.knows.contains(robot);
      if (has_spoken && extent.life != own->second.knows.at(robot).life) {
        if (is_new) known->second = own->second.knows.at(robot);
      } else if (!is_new && is_more) {
        known->second = extent;
      }
    }
  }
  return most;
}

std::map<std::string, Want> Asking::wants(Stamp now, const std::string& self,
                                          const std::map<std::string, LogExtent>& extents,
                                          const std::map<std::string, Peer>& peers, const Missing& missing) {
  std::map<std::string, Want> wants;
  const std::map<std::string, LogExtent> known = known_by(peers, self, now);
  std::erase_if(asked_, [&](const auto& of) { return !known.contains(of.first); });
  for (const auto& [robot, most] : known) {
    const auto own = extents.find(robot);
    const bool is_other_life = own == extents.end() || own->second.life != most.life;
    if (!is_other_life && own->second.records >= most.records) continue;
    if (is_other_life && own != extents.end() && own->second.life > most.life) continue;
    if (most.records == 0) continue;
    const Stretches lacking = is_other_life ? Stretches{{0, most.records - 1}} : missing(robot, most.records);
    const auto peer = whom(robot, most, lacking, now, peers);
    if (!peer) continue;
    for (const auto& [first, last] : lacking)
      wants[*peer].stretches.push_back({robot, most.life, first, last + 1});
  }
  for (auto& [peer, want] : wants) want.stretches.resize(std::min(want.stretches.size(), kMaxStretches));
  return wants;
}

std::optional<std::string> Asking::whom(const std::string& robot, const LogExtent& most,
                                        const Stretches& missing, Stamp now,
                                        const std::map<std::string, Peer>& peers) {
  std::vector<std::string> able;
  for (const auto& [name, peer] : peers) {
    const auto extent = peer.knows.find(robot);
    if (!peer.is_heard(now) || extent == peer.knows.end() || extent->second.life != most.life ||
        extent->second.records <= missing.front().first)
      continue;
    able.insert(name == robot ? able.begin() : able.end(), name);
  }
  if (able.empty()) return std::nullopt;
  const auto count = [&](std::uint64_t end) {
    std::uint64_t left = 0;
    for (const auto& [first, last] : missing)
      if (first < end) left += std::min(last + 1, end) - first;
    return left;
  };
  Asked& asked = asked_.try_emplace(robot).first->second;
  const std::uint64_t left = asked.life == most.life ? count(asked.end) : 0;
  if (left > 0) {
    if (left < asked.left) asked.at = now;  // it comes
    asked.left = left;
    if (seconds_between(asked.at, now) < kRepeat_s) return std::nullopt;
    ++asked.tries;
  } else {
    asked.tries = 0;
  }
  asked.at = now;
  asked.life = most.life;
  asked.end = most.records;
  asked.left = count(asked.end);
  return able[asked.tries % able.size()];
}

}  // namespace radioslam
