// Robots whose recording is that of another robot.
#pragma once

#include <string>
#include <vector>

#include "radioslam/mission/finding.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// Adds `finding` once for every robot that is the `same` as an earlier one, with its id and the other's id
/// quoted at the end of what was found. `file_of` gives the file of a robot's id.
void add_duplicates(const Mission& mission, const auto& same, const auto& file_of, const Finding& finding,
                    std::vector<Finding>& findings) {
  for (std::size_t b = 1; b < mission.robots.size(); ++b)
    for (std::size_t a = 0; a < b; ++a) {
      if (!same(mission.robots[a], mission.robots[b])) continue;
      Finding& found = findings.emplace_back(finding);
      found.robot = mission.robots[b].id;
      found.file = file_of(found.robot);
      found.found += " robot '" + mission.robots[a].id + "'";
      break;
    }
}

}  // namespace radioslam
