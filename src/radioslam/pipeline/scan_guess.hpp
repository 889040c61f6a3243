// What is told of a scan before it is laid onto the map, by other means than scans.
#pragma once

#include <optional>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/pipeline/swept_way.hpp"

namespace radioslam {

struct ScanGuess {
  std::optional<SE3> T_previous_body;  ///< since the last scan; nothing before the first
  SweptWay way;
};

/// By recorded odometry, straight from row to row. Nothing where it does not cover the sweep and the time
/// since `previous`, the last scan's stamp, or where its rows there are farther apart than `most_rows_s`.
std::optional<ScanGuess> guess_by_odometry(const Trajectory<SE3>& odometry, std::optional<Stamp> previous,
                                           Stamp stamp, const SweptTime& time, double most_rows_s);

/// The longest time between two rows in a row, of those that have any of the time from `begin` to `end`
/// between them; the trajectory covers both.
double longest_between_rows_s(const Trajectory<SE3>& rows, Stamp begin, Stamp end);

}  // namespace radioslam
