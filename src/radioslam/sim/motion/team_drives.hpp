// Drives of a team over a grid of lanes, such that its robots come into range of each other.
//
// Each robot drives its own route (drive.hpp) from its own crossing. Routes are drawn until the robot is
// within `contact_range_m` of an earlier one for `min_contact_s`, a quarter of that in every quarter of the
// mission; if no draw is, the one with the longest contact is used. So the team is connected by contacts
// spread over the mission, and its routes partly overlap.
#pragma once

#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/sim/motion/drive.hpp"
#include "radioslam/sim/worlds/hills.hpp"
#include "radioslam/sim/worlds/lane_grid.hpp"

namespace radioslam {

struct TeamDriveParams {
  int robots = 2;
  DriveParams drive;
  double rate_hz = 10;  ///< poses per second
  double contact_range_m = 100;
  double min_contact_s = 0;
  int draws = 100;
};

/// T_common_body of each robot, all from time 0. A larger team keeps the drives of its first robots.
std::vector<Trajectory<SE3>> drive_team(const LaneGrid& lanes, const Hills& ground,
                                        const TeamDriveParams& params, const Rng& rng);

}  // namespace radioslam
