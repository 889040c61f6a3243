// What a robot's agent sends, as fast as the others take it.
//
// More than kMostWaiting messages to one robot are not kept: they are left out and counted, and so are those
// to a robot that is not there. What is lacking then is asked for again.
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <string>

#include "radioslam/io/dds/team_channel.hpp"
#include "radioslam/team/virtual_network.hpp"

namespace radioslam::cli {

class Outbox {
 public:
  static constexpr std::size_t kMostWaiting = 1024;

  /// Of robot `self`.
  Outbox(std::string self, TeamChannel& channel) : self_(std::move(self)), channel_(channel) {}

  /// A message to all is counted for each peer that is heard.
  void add(SentMessage message, const std::map<std::string, Peer>& peers, Stamp now);
  /// As many as there is room for.
  void send();
  bool empty() const { return waiting_.empty(); }
  /// Lost: left out. What is lost on the way, nobody knows.
  const TeamTraffic& traffic() const { return traffic_; }

 private:
  LinkTraffic& link(const SentMessage& message, const std::string& to) {
    return traffic_[{self_, to, message.kind}];
  }
  bool send(const SentMessage& message);

  std::string self_;
  TeamChannel& channel_;
  std::map<std::string, std::deque<SentMessage>> waiting_;
  TeamTraffic traffic_;
};

}  // namespace radioslam::cli
