// Where a stretch fits among many others, by branch and bound over all of them at once.
//
// A pose's score is the mean value of the stretch's points on a grid (stretch_grid.hpp), less that of unseen
// cells: 1 if all are occupied, below 0 if many are free. Blocks of poses, of one heading each, are divided
// in the order of their bounds, so that the first single pose that comes up is the best of all.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "radioslam/geometry/se2.hpp"
#include "radioslam/places/stretches/stretch_grid.hpp"

namespace radioslam {

/// A grid on which a stretch is searched.
struct SearchedStretch {
  const StretchGrid* grid = nullptr;
  SE2 T_world_grid;             ///< by which places on different grids are compared
  SE2 T_grid_points;            ///< where the points are expected
  double turn_rad = 0;          ///< largest deviation of the heading
  Eigen::Vector2d least, most;  ///< bounds of the position
};

struct FoundPlace {
  std::size_t stretch = 0;
  SE2 T_grid_points;
  double score = 0;
};

struct StretchSearchLimits {
  double min_score = 0.4;
  double min_ratio = 0.75;            ///< of the best's score
  double same_m = 1, same_rad = 0.2;  ///< places this near to a better one are left out
  std::size_t max_places = 12;
  std::size_t max_blocks = 100000;
};

/// Best first.
std::vector<FoundPlace> search_stretches(const std::vector<Eigen::Vector2d>& points,
                                         const std::vector<SearchedStretch>& stretches,
                                         const StretchSearchLimits& limits);

}  // namespace radioslam
