// Stamps of messages, and why some cannot be used: not set, of another clock, repeated.
//
// A stamp may be kFarFromClock_s off the robot's clock: one that is farther ahead would make all others late.
// Topics whose stamps differ by more than kApart_s when they arrive are said, since the front end waits no
// longer for late samples.
#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "radioslam/base/stamp.hpp"
#include "radioslam/ros_node/notes_once.hpp"

namespace radioslam {

class StampGate {
 public:
  static constexpr double kFarFromClock_s = 5, kApart_s = 0.3;

  explicit StampGate(bool is_simulated) : is_simulated_(is_simulated) {}

  /// Whether a message of the topic can be used; `clock`: the robot's, when it arrived.
  bool passes(const std::string& topic, Stamp stamp, Stamp clock, NotesOnce& notes);
  /// Whether the topic's stamp has not passed before, among those of the last seconds.
  bool is_new(const std::string& topic, Stamp stamp, NotesOnce& notes);

 private:
  struct Topic {
    std::set<Stamp> recent;
    double least_delay_s = std::numeric_limits<double>::infinity();
    std::size_t passed = 0;
  };

  void compare_delays(const std::string& topic, NotesOnce& notes);

  bool is_simulated_;
  std::map<std::string, Topic> topics_;
};

}  // namespace radioslam
