// Time windows for AoA measurements: windows of a receiver's path or rotation, and when a transmitter stood
// still.
#pragma once

#include <vector>

#include "radioslam/mission/mission.hpp"

namespace radioslam {

struct TimeWindow {
  Stamp begin, end;
};

/// Windows in which the body stayed within `reach_m` of its position at their begin.
std::vector<TimeWindow> still_times(const Trajectory<SE3>& odometry, double reach_m);

/// Windows of equal path length within `during`, each about `length_m` long; none if the path is shorter than
/// `min_m`.
std::vector<TimeWindow> path_windows(const Trajectory<SE3>& odometry, const TimeWindow& during,
                                     double length_m, double min_m);

/// Windows in which the body turned by about `turn_rad`, however it moved.
std::vector<TimeWindow> turns_of(const Trajectory<SE3>& odometry, double turn_rad);

}  // namespace radioslam
