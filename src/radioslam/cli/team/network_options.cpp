#include "radioslam/cli/team/network_options.hpp"

#include <optional>
#include <sstream>
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

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text + separator);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
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

/// "60:120:a,b": two times, and the robots that are cut off from the others.
Partition partition_of(const std::string& text, const Mission& mission, Stamp begin) {
  const std::vector<std::string> parts = split(text, ':');
  if (parts.size() != 2 && parts.size() != 3)
    throw InputError("--partition", 0, "'" + text + "' is not two times, as in 60:120 or 60:120:a,b");
  Partition partition{after(begin, seconds_of("--partition", parts[0])),
                      after(begin, seconds_of("--partition", parts[1]))};
  if (!(partition.begin < partition.end)) throw InputError("--partition", 0, "it ends before it begins");
  if (parts.size() == 2) return partition;
  for (const std::string& id : split(parts[2], ',')) {
    robot_named(id, mission, "--partition");
    partition.apart.insert(id);
  }
  return partition;
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
  if (!options.partition.empty()) faults.partition = partition_of(options.partition, mission, begin);
  for (const std::string& text : options.late) {
    const auto [robot, seconds] = robot_and_time("--late", text, ':', mission);
    faults.late[robot] = after(begin, seconds);
  }
  return faults;
}

std::map<std::string, Kill> kills_of(const NetworkOptions& options, const Mission& mission, Stamp begin) {
  std::map<std::string, Kill> kills;
  for (const std::string& text : options.kills) {
    const std::size_t colon = text.find(':', text.rfind('@') + 1);
    const auto [robot, seconds] = robot_and_time("--kill", text.substr(0, colon), '@', mission);
    Kill kill{after(begin, seconds)};
    if (colon != std::string::npos) {
      kill.back = after(begin, seconds_of("--kill", text.substr(colon + 1)));
      if (!(kill.at < *kill.back))
        throw InputError("--kill", 0, "robot " + robot + " is back before it is killed");
    }
    if (!kills.emplace(robot, kill).second)
      throw InputError("--kill", 0, "robot " + robot + " is killed twice");
  }
  return kills;
}

}  // namespace radioslam::cli
