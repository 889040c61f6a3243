// What becomes of someone else's recordings.
#pragma once

#include <string>
#include <vector>

#include "radioslam/mission/mission.hpp"
#include "radioslam/mission/truth.hpp"

namespace radioslam {

/// A mission and its truth from someone else's recordings.
struct ImportedMission {
  Mission mission;
  Truth truth;
  std::vector<std::string> warnings;  ///< what a user should know about the source, one line each
};

}  // namespace radioslam
