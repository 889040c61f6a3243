#include "radioslam/ros_node/stamp_gate.hpp"

#include <cmath>
#include <sstream>

namespace radioslam {
namespace {

constexpr double kRecent_s = 10;
constexpr std::size_t kCompared = 20;  // messages of a topic, the one with the least delay of which counts
constexpr double kSecondsOfDays = 2 * 86400;

std::string in_seconds(double seconds) {
  std::ostringstream text;
  text.precision(3);
  if (std::abs(seconds) < kSecondsOfDays)
    text << std::abs(seconds) << " s";
  else
    text << std::abs(seconds) / 86400 << " days";
  return text.str();
}

}  // namespace

bool StampGate::passes(const std::string& topic, Stamp stamp, Stamp clock, NotesOnce& notes) {
  const std::string name = "topic " + topic + ": ";
  if (stamp.ns <= 0) {
    notes.say(name + "stamps are zero, these messages are left out; its driver does not set header.stamp");
    return false;
  }
  const double delay_s = static_cast<double>(clock.ns) * 1e-9 - static_cast<double>(stamp.ns) * 1e-9;
  if (std::abs(delay_s) > kFarFromClock_s) {
    const std::string cause =
        is_simulated_ ? "does its driver use the host's time, unlike --use-sim-time?"
                      : "a recording that is played wants --use-sim-time and `ros2 bag play --clock`, a "
                        "sensor's or another host's clock wants to be synchronised";
    notes.say(name + "stamps are far from this robot's clock, these messages are left out",
              " (" + in_seconds(delay_s) + (delay_s > 0 ? " behind it" : " ahead of it") + "); " + cause);
    return false;
  }
  Topic& of = topics_[topic];
  of.least_delay_s = std::min(of.least_delay_s, delay_s);
  if (++of.passed == kCompared) compare_delays(topic, notes);
  return true;
}

void StampGate::compare_delays(const std::string& topic, NotesOnce& notes) {
  const double own_s = topics_.at(topic).least_delay_s;
  for (const auto& [other, of] : topics_) {
    if (of.passed < kCompared || other == topic) continue;
    const double behind_s = own_s - of.least_delay_s;
    if (std::abs(behind_s) <= kApart_s) continue;
    notes.say("topics " + (behind_s > 0 ? topic : other) + " and " + (behind_s > 0 ? other : topic) +
                  " have stamps of different clocks",
              ": those of the first are " + in_seconds(behind_s) +
                  " older when they arrive, and samples that are late by more than 0.3 s are left out");
  }
}

bool StampGate::is_new(const std::string& topic, Stamp stamp, NotesOnce& notes) {
  auto& recent = topics_[topic].recent;
  const Stamp forgotten{stamp.ns - Stamp::from_seconds(kRecent_s).ns};
  recent.erase(recent.begin(), recent.lower_bound(forgotten));
  if (recent.insert(stamp).second) return true;
  notes.say("topic " + topic + ": messages with the same stamp as another one are left out");
  return false;
}

}  // namespace radioslam
