// The drives of a team over a grid of lanes, such that its robots meet.
//
// Each robot drives a route of its own (drive.hpp) from a crossing of its own. Both are drawn again until the
// robot is within `meeting_range_m` of one of those before it for `least_meeting_s`, a quarter of that in
// every quarter of the mission; if no draw is, the one that comes nearest to it stands. So a team hangs
// together, its meetings spread over the mission, and it covers partly the same lanes.
#pragma once

#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/sim/drive.hpp"
#include "radioslam/sim/hills.hpp"
#include "radioslam/sim/lane_grid.hpp"

namespace radioslam {

struct TeamDriveParams {
  int robots = 2;
  DriveParams drive;
  double rate_hz = 10;  ///< poses per second
  double meeting_range_m = 100;
  double least_meeting_s = 0;
  int draws = 100;
};

/// T_common_body of each robot, all from time 0 on. The same for the first robots of a larger team.
std::vector<Trajectory<SE3>> drive_team(const LaneGrid& lanes, const Hills& ground,
                                        const TeamDriveParams& params, const Rng& rng);

}  // namespace radioslam
