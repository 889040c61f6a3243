// Ground under a path whose heights are all that is known of it.
//
//   h(p) = sum of w_k z_k / sum of w_k,   w_k = exp(-d_k^2 / (2 s^2) - z_k / 1 m),
//   s^2 = (3 m)^2 + d_min^2 / 4
//
// over the path's places, d_k away from p and z_k high. At the path this smooths over a few metres, further
// away over more. Where passages of the same place disagree in height, as those of a recorded drive do, it is
// within some decimetres of the lowest. Cost: the grid's cells times the places.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "radioslam/sim/worlds/height_grid.hpp"

namespace radioslam {

/// Of at least one place, reaching `reach_m` beyond all of them; cells of 4 m, larger on large floors.
HeightGrid ground_under(const std::vector<Eigen::Vector3d>& path, double reach_m);

}  // namespace radioslam
