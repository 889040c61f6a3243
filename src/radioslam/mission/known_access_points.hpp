// Access points whose positions the mission states: anchors (radio/anchors.csv) that are named by a BSSID.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "radioslam/mission/mission.hpp"

namespace radioslam {

struct KnownAccessPoint {
  AccessPointIndex access_point;
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();  ///< in the common frame
  double sigma_m = 0;                                    ///< per axis
};

/// The anchors with a position whose name is the BSSID of an access point that a robot received, in any
/// capitals and with ':' or '-', in the order of the access points.
std::vector<KnownAccessPoint> known_access_points(const Mission& mission);

}  // namespace radioslam
