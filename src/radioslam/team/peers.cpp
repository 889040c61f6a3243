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

std::optional<std::string> Asking::whom(const WantedStretch& stretch, Stamp now,
                                        const std::map<std::string, Peer>& peers) {
  std::vector<std::string> able;
  for (const auto& [name, peer] : peers) {
    const auto extent = peer.knows.find(stretch.robot);
    if (!peer.is_heard(now) || extent == peer.knows.end() || extent->second.life != stretch.life ||
        extent->second.records <= stretch.first)
      continue;
    able.insert(name == stretch.robot ? able.begin() : able.end(), name);
  }
  if (able.empty()) return std::nullopt;
  Asked& asked = asked_.try_emplace(stretch.robot).first->second;
  const bool is_open = asked.stretch.life == stretch.life && stretch.first < asked.stretch.end;
  if (is_open) {
    if (asked.stretch.first != stretch.first) asked.at = now;  // it comes
    asked.stretch.first = stretch.first;
    if (seconds_between(asked.at, now) < kRepeat_s) return std::nullopt;
    ++asked.tries;
  } else {
    asked.tries = 0;
  }
  asked.at = now;
  asked.stretch = stretch;
  return able[asked.tries % able.size()];
}

}  // namespace radioslam
