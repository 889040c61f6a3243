// Result of importing a recording or data set.
#pragma once

#include <string>
#include <vector>

#include "radioslam/mission/mission.hpp"
#include "radioslam/mission/truth.hpp"

namespace radioslam {

/// A mission and its ground truth, imported from an external recording.
struct ImportedMission {
  Mission mission;
  Truth truth;
  std::vector<std::string> warnings;  ///< notes for the user on the source, one line each
};

}  // namespace radioslam
