// What robots say to each other. A status says all of a robot's state that concerns others, and is said again
// with every decision: one that is lost does no harm, and one that is old is known by its number.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "radioslam/geometry/se2.hpp"

namespace radioslam {

/// How much of a robot's log somebody knows.
struct LogVersion {
  std::uint32_t life = 0;     ///< which recording of the robot it is
  std::uint64_t records = 0;  ///< without a gap
  double until_s = 0;         ///< what the robot measured until then is in them
  bool operator==(const LogVersion&) const = default;
};

struct RobotStatus {
  std::uint64_t number = 0;  ///< rises from one status to the next
  double error = 0;
  std::string frame;  ///< robot whose start is the origin of `pose`; empty: the common frame
  SE2 pose;
  double sigma_m = 0;                       ///< of the position, per axis
  std::optional<std::uint32_t> call;        ///< the robot asks for a rendezvous: the number of its call
  double call_error = 0;                    ///< when it called
  double alpha = 1;                         ///< priority of the robot that calls
  std::string partner;                      ///< of those who offered, the one it has taken; empty: none yet
  std::string offer_to;                     ///< whose call this robot would follow
  std::string serving;                      ///< to whom it walks
  bool standing = false;                    ///< as a landmark
  std::string leans_on;                     ///< landmark that it comes back to
  double walked_m = 0;                      ///< so far
  std::map<std::string, LogVersion> knows;  ///< by robot, itself included
};

struct RobotMessage {
  std::optional<RobotStatus> status;
  std::string records;  ///< chunks of robots' logs (records/team_log.hpp)
};

}  // namespace radioslam
