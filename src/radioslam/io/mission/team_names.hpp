// Names that may appear in a mission's tables: robots, their antennas, anchors.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "radioslam/base/strong_id.hpp"
#include "radioslam/mission/radio_links.hpp"

namespace radioslam {

/// Lever arms of a robot's antennas in its body frame, by name.
using Antennas = std::map<std::string, Eigen::Vector3d, std::less<>>;

struct TeamNames {
  std::map<std::string, RobotIndex, std::less<>> robots;
  std::vector<Antennas> antennas = {};  ///< per robot; may be shorter
  std::map<std::string, AnchorIndex, std::less<>> anchors = {};
};

}  // namespace radioslam
