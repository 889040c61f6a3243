// The faults of a team's network and programs, as the command line states them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "radioslam/mission/mission.hpp"
#include "radioslam/team/scripted_robots.hpp"
#include "radioslam/team/virtual_network.hpp"

namespace radioslam::cli {

struct NetworkOptions {
  std::string partition;           ///< T0:T1[:ROBOT,...]
  std::vector<std::string> kills;  ///< ROBOT@T[:T_BACK]
  std::vector<std::string> late;   ///< ROBOT:T
  double loss = 0, delay_s = 0.05;
  std::uint64_t seed = 1;
};

/// The mission's robot of that name. Throws InputError naming the option.
RobotIndex robot_named(const std::string& id, const Mission& mission, const std::string& option);

/// Times are seconds from `begin` on. Throws InputError naming the option.
NetworkFaults faults_of(const NetworkOptions& options, const Mission& mission, Stamp begin);
/// When which robots' programs are killed.
std::map<std::string, Kill> kills_of(const NetworkOptions& options, const Mission& mission, Stamp begin);

}  // namespace radioslam::cli
