// Houses of a town: rows of boxes of random sizes on both sides of every street, closed or not, with gaps
// between them. Frame: that of the streets.
#pragma once

#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/sim/worlds/hills.hpp"
#include "radioslam/sim/worlds/lane_grid.hpp"
#include "radioslam/sim/worlds/upright_shapes.hpp"

namespace radioslam {

/// Street grid of a town: square blocks, with some streets closed between two crossings. Frame: origin at a
/// corner crossing, x and y along the streets; metres.
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

struct TownHouseParams {
  double street_width_m = 16;
  double house_setback_m = 2;
  double house_gap_m = 3;
  double house_min_m = 7;
  double house_max_m = 14;
  double house_min_height_m = 4;
  double house_max_height_m = 12;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(street_width_m, "m", 2, 100,
                    "smallest distance between the houses on both sides of a street");
    RADIOSLAM_FIELD(house_setback_m, "m", 0, 50, "largest setback of a house from the street");
    RADIOSLAM_FIELD(house_gap_m, "m", 0, 50, "largest gap between adjacent houses");
    RADIOSLAM_FIELD(house_min_m, "m", 1, 100, "smallest side of a house");
    RADIOSLAM_FIELD(house_max_m, "m", 1, 100, "largest side of a house");
    RADIOSLAM_FIELD(house_min_height_m, "m", 1, 100, "smallest height of a house");
    RADIOSLAM_FIELD(house_max_height_m, "m", 1, 100, "largest height of a house");
  }
};

/// Houses of the whole town, upright on the ground; none if its blocks are smaller than its streets.
std::vector<UprightBox> build_houses(const StreetGridParams& streets, const TownHouseParams& params,
                                     const Hills& ground, const Rng& rng);

}  // namespace radioslam
