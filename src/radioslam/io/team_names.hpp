// Who may be named in a mission's tables: robots, their antennas, anchors.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "radioslam/base/strong_id.hpp"
#include "radioslam/mission/radio_links.hpp"

namespace radioslam {

/// Where each of a robot's antennas sits in its body frame.
using Antennas = std::map<std::string, Eigen::Vector3d, std::less<>>;

struct TeamNames {
  std::map<std::string, RobotIndex, std::less<>> robots;
  std::vector<Antennas> antennas = {};  ///< per robot; may be shorter
  std::map<std::string, AnchorIndex, std::less<>> anchors = {};
};

}  // namespace radioslam
