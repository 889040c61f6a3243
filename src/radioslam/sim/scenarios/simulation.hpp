// Output of a simulated scenario: recordings as robots would make them, and the truth.
#pragma once

#include "radioslam/mission/mission.hpp"
#include "radioslam/mission/truth.hpp"

namespace radioslam {

/// A mission and its truth, robot for robot.
struct Simulation {
  Mission mission;
  Truth truth;
};

}  // namespace radioslam
