// When a robot's motion makes an array: pieces of its way during which the other robot stood still.
#pragma once

#include <vector>

#include "radioslam/mission/mission.hpp"

namespace radioslam {

struct TimeWindow {
  Stamp begin, end;
};

/// Stretches of time in which the body stayed within `reach_m` of where it was at their begin.
std::vector<TimeWindow> still_times(const Trajectory<SE3>& odometry, double reach_m);

/// Pieces of the way within `during`, each about `length_m` long, none shorter than `least_m`.
std::vector<TimeWindow> pieces_of_way(const Trajectory<SE3>& odometry, const TimeWindow& during,
                                      double length_m, double least_m);

/// Pieces in which the body turned about so much, however it moved.
std::vector<TimeWindow> turns_of(const Trajectory<SE3>& odometry, double turn_rad);

}  // namespace radioslam
