// Teams with made graphs in space: relative poses with the noise that their information states, and every
// robot's values by its own odometry.
#pragma once

#include <cstdint>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/graph/team_graph.hpp"

namespace radioslam {

/// Robots in a grid, each of which sweeps a block of `side` by `side` places that overlaps its neighbours' by
/// a third: closures between neighbouring places, also of different robots, so that most poses are seen by
/// others.
TeamGraph<SE3> simulate_blocks(std::size_t rows, std::size_t columns, std::size_t side, std::uint64_t seed);

/// Robots in two rows (two robots: in one) that drive a lap of some 370 m each: closures only where laps
/// cross and where a lap ends.
TeamGraph<SE3> simulate_laps(std::size_t robots, std::uint64_t seed);

}  // namespace radioslam
