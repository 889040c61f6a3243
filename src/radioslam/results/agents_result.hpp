// What the agents of a team knew on their way, and what they sent, for the report.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/stamp.hpp"

namespace radioslam {

struct AgentsResult {
  struct Known {
    Stamp at;
    std::string agent;
    double share = 0;                 ///< of the records that all robots have said
    std::optional<double> error_m{};  ///< of the largest frame it knows, RMSE; where the truth is known
  };
  struct Sent {
    std::size_t messages = 0, bytes = 0, lost = 0;
  };
  struct Event {
    Stamp at;
    std::string what;
  };
  std::vector<Known> known;          ///< in time order
  std::map<std::string, Sent> sent;  ///< by kind
  std::vector<Event> events;         ///< in time order
};

}  // namespace radioslam
