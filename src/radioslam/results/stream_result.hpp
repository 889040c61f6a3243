// How the estimate of a streamed mission went, for the report.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/stamp.hpp"

namespace radioslam {

struct StreamResult {
  struct Estimate {
    Stamp at;
    std::string effort;
    std::size_t frames = 0;         ///< that share no robot
    std::optional<double> error_m;  ///< of the frame with the most robots, RMSE; where it was compared
  };
  struct Event {
    Stamp at;
    std::string what;
    bool is_join = false;  ///< a robot comes into a frame, or leaves one
  };
  std::vector<Estimate> estimates;
  std::vector<Event> events;
};

}  // namespace radioslam
