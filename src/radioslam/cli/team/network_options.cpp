#include "radioslam/cli/team/network_options.hpp"

#include <optional>
#include <utility>

#include "radioslam/base/input_error.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam::cli {
namespace {

double seconds_of(const std::string& option, const std::string& text) {
  const auto seconds = parse_number(text);
  if (!seconds || !(*seconds >= 0)) throw InputError(option, 0, "'" + text + "' is not a time in seconds");
  return *seconds;
}

Stamp after(Stamp begin, double seconds) { return {begin.ns + Stamp::from_seconds(seconds).ns}; }

/// "b@120": robot and time.
std::pair<std::string, double> robot_and_time(const std::string& option, const std::string& text,
                                              char separator, const Mission& mission) {
  const std::size_t at = text.rfind(separator);
  if (at == std::string::npos)
    throw InputError(option, 0, "'" + text + "' is not a robot and a time, as in b" + separator + "120");
  const std::string id = text.substr(0, at);
  robot_named(id, mission, option);
  return {id, seconds_of(option, text.substr(at + 1))};
}

}  // namespace

RobotIndex robot_named(const std::string& id, const Mission& mission, const std::string& option) {
  for (std::size_t r = 0; r < mission.robots.size(); ++r)
    if (mission.robots[r].id == id) return RobotIndex(r);
  throw InputError(option, 0, "the mission has no robot '" + id + "'");
}

NetworkFaults faults_of(const NetworkOptions& options, const Mission& mission, Stamp begin) {
  NetworkFaults faults;
  faults.loss = options.loss;
  faults.delay_s = options.delay_s;
  faults.seed = options.seed;
  if (!options.partition.empty()) {
    const std::size_t colon = options.partition.find(':');
    if (colon == std::string::npos)
      throw InputError("--partition", 0, "'" + options.partition + "' is not two times, as in 60:120");
    const double from = seconds_of("--partition", options.partition.substr(0, colon)),
                 to = seconds_of("--partition", options.partition.substr(colon + 1));
    if (!(from < to)) throw InputError("--partition", 0, "it ends before it begins");
    faults.partition = {after(begin, from), after(begin, to)};
  }
  for (const std::string& text : options.late) {
    const auto [robot, seconds] = robot_and_time("--late", text, ':', mission);
    faults.late[robot] = after(begin, seconds);
  }
  return faults;
}

std::map<std::string, Stamp> kills_of(const NetworkOptions& options, const Mission& mission, Stamp begin) {
  std::map<std::string, Stamp> kills;
  for (const std::string& text : options.kills) {
    const auto [robot, seconds] = robot_and_time("--kill", text, '@', mission);
    if (!kills.emplace(robot, after(begin, seconds)).second)
      throw InputError("--kill", 0, "robot " + robot + " is killed twice");
  }
  return kills;
}

}  // namespace radioslam::cli
