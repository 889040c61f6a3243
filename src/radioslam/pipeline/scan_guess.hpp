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

/// By recorded odometry, straight from row to row. Nothing where it does not cover the sweep; `previous`: the
/// last scan's stamp.
std::optional<ScanGuess> guess_by_odometry(const Trajectory<SE3>& odometry, std::optional<Stamp> previous,
                                           Stamp stamp, const SweptTime& time);

}  // namespace radioslam
