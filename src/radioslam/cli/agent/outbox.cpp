#include "radioslam/cli/agent/outbox.hpp"

#include <utility>

namespace radioslam::cli {

bool Outbox::send(const SentMessage& message) {
  using Delivery = TeamChannel::Delivery;
  return channel_.send(message.to, static_cast<std::uint8_t>(message.kind), message.bytes,
                       message.to.empty() ? Delivery::kBestEffort : Delivery::kReliable);
}

void Outbox::add(SentMessage message, const std::map<std::string, Peer>& peers, Stamp now) {
  const auto count = [&](const std::string& to, bool is_lost) {
    LinkTraffic& of = link(message, to);
    ++of.messages;
    of.bytes += message.bytes.size();
    of.lost += is_lost ? 1 : 0;
  };
  if (message.to.empty()) {
    const bool is_sent = send(message);
    for (const auto& [name, peer] : peers)
      if (peer.is_heard(now)) count(name, !is_sent);
    return;
  }
  auto& waiting = waiting_[message.to];
  const bool has_room = waiting.size() < kMostWaiting;
  count(message.to, !has_room);
  if (has_room) waiting.push_back(std::move(message));
}

void Outbox::send() {
  for (auto to = waiting_.begin(); to != waiting_.end();) {
    auto& [robot, messages] = *to;
    for (; !messages.empty() && channel_.has_room(robot); messages.pop_front())
      if (!send(messages.front())) ++link(messages.front(), robot).lost;
    to = messages.empty() ? waiting_.erase(to) : std::next(to);
  }
}

}  // namespace radioslam::cli
