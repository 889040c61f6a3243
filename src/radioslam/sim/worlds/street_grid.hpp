// Street grid of a town: square blocks, with some streets closed between two crossings. Frame: origin at a
// corner crossing, x and y along the streets; metres.
#pragma once

#include "radioslam/base/fields.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/sim/worlds/lane_grid.hpp"

namespace radioslam {

struct StreetGridParams {
  int blocks_x = 5;
  int blocks_y = 5;
  double block_m = 100;
  double closed_street_ratio = 0.1;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(blocks_x, "", 1, 49, "number of blocks of houses along x");
    RADIOSLAM_FIELD(blocks_y, "", 1, 49, "number of blocks of houses along y");
    RADIOSLAM_FIELD(block_m, "m", 20, 1000, "distance between adjacent streets");
    RADIOSLAM_FIELD(closed_street_ratio, "", 0, 0.5,
                    "ratio of street sections between crossings that are not driven");
  }
};

/// The streets as lanes to drive.
LaneGrid make_streets(const StreetGridParams& params, Rng rng);

}  // namespace radioslam
