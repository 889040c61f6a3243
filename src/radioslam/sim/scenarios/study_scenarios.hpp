// The scenarios of the project's studies: parameters that differ from a scenario's defaults.
#pragma once

#include "radioslam/sim/scenarios/city.hpp"
#include "radioslam/sim/scenarios/hall.hpp"
#include "radioslam/sim/scenarios/kitti.hpp"

namespace radioslam {

/// Drive of wi-closure-kitti: forty true matches, and 120 false ones that are consistent with each other.
KittiParams wi_closure_drive();

/// Drive of wi-closure-table1: scanned by 16 beams at 600 azimuths up to 30 m, no matches. In the plane,
/// because in the truth of KITTI 08 passages of the same place are at different heights.
KittiParams scanned_drive();

/// Hall of wi-closure-hall: scanned by 16 beams, no matches.
HallParams scanned_hall();

/// Town of robustness-map: small enough for a map of hundreds of them; the LiDAR's range is that of `city`.
CityParams robustness_town();

}  // namespace radioslam
