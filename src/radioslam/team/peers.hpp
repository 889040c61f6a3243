// What an agent knows of those it hears, and what it owes each of them.
//
// A link is to one peer and has a budget of bytes: what is over it waits, and is not lost, since what is sent
// later is whatever the peer lacks then. In this order: digests, wants, own records, records of others that
// it asked for, clouds. Nothing is pushed to a peer that was not heard for kSilent_s.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/team/messages.hpp"

namespace radioslam {

inline constexpr double kSilent_s = 5;

/// Bytes that a link may send, as they come: at most so many a second, and those of one second at once. A
/// message of more than these is sent when nothing else has been sent for a second; nothing is sent then
/// until the rate is kept again.
class ByteBudget {
 public:
  /// 0: no bound.
  explicit ByteBudget(double bytes_s = 0) : bytes_s_(bytes_s) {}

  void refill(Stamp now);
  bool has(std::size_t bytes) const {
    return bytes_s_ == 0 || left_ >= std::min(static_cast<double>(bytes), bytes_s_);
  }
  void take(std::size_t bytes) { left_ -= static_cast<double>(bytes); }
  /// Of one message now, at most so many.
  std::size_t at_most(std::size_t bytes) const;

 private:
  double bytes_s_, left_ = 0;
  std::optional<Stamp> filled_;
};

struct Peer {
  std::optional<Stamp> heard = {};
  std::map<std::string, LogExtent> knows = {};                    ///< as it last said
  bool solves = true;                                             ///< as it last said
  std::uint64_t sent_own = 0;                                     ///< own records up to this number are sent
  std::map<std::string, std::vector<WantedStretch>> wanted = {};  ///< by it, by robot
  std::set<Stamp> clouds = {};                                    ///< wanted by it
  std::optional<Stamp> clouds_wait = {};                          ///< since when none of these went
  bool is_cloud_wait_said = false;
  ByteBudget budget{};
  std::map<std::string, std::size_t> refused = {};  ///< of what it sent, by reason

  bool is_heard(Stamp now) const { return heard && seconds_between(*heard, now) <= kSilent_s; }
};

/// Which records the agent asks whom for. A stretch is asked for again after kRepeat_s without progress, of
/// another peer that has it: of the robot itself first.
class Asking {
 public:
  static constexpr double kRepeat_s = 2;

  using Stretches = std::vector<std::pair<std::uint64_t, std::uint64_t>>;
  using Missing = std::function<Stretches(const std::string& robot, std::uint64_t end)>;

  /// `extents`: what the agent has; `missing`: first and last numbers of what it lacks of a robot's life.
  std::map<std::string, Want> wants(Stamp now, const std::string& self,
                                    const std::map<std::string, LogExtent>& extents,
                                    const std::map<std::string, Peer>& peers, const Missing& missing);

 private:
  struct Asked {
    Stamp at;
    std::uint32_t life = 0;
    std::uint64_t left = 0;  ///< records of the stretches that did not come yet
    std::uint64_t end = 0;
    std::size_t tries = 0;
  };

  static std::map<std::string, LogExtent> known_by(const std::map<std::string, Peer>& peers,
                                                   const std::string& self, Stamp now);
  /// Whom to ask now for what is missing of a robot's log, if anybody.
  std::optional<std::string> whom(const std::string& robot, const LogExtent& most, const Stretches& missing,
                                  Stamp now, const std::map<std::string, Peer>& peers);

  std::map<std::string, Asked> asked_;
};

}  // namespace radioslam
