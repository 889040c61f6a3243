// The houses along the streets of a town: rows of boxes of all sizes on both sides of every street, closed or
// not, with gaps between them. Frame: that of the streets (street_grid.hpp).
#pragma once

#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/sim/hills.hpp"
#include "radioslam/sim/street_grid.hpp"
#include "radioslam/sim/upright_shapes.hpp"

namespace radioslam {

struct TownHouseParams {
  double street_width_m = 16;
  double house_setback_m = 2;
  double house_gap_m = 3;
  double house_least_m = 7;
  double house_most_m = 14;
  double house_least_height_m = 4;
  double house_most_height_m = 12;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"street_width_m", "m", 2, 100, "from the houses on one side to those on the other, at least"},
          self.street_width_m);
    visit(Field{"house_setback_m", "m", 0, 50, "a house stands up to so far back"}, self.house_setback_m);
    visit(Field{"house_gap_m", "m", 0, 50, "up to so far from the next one"}, self.house_gap_m);
    visit(Field{"house_least_m", "m", 1, 100, "sides of a house, at least"}, self.house_least_m);
    visit(Field{"house_most_m", "m", 1, 100, "and at most"}, self.house_most_m);
    visit(Field{"house_least_height_m", "m", 1, 100, "height of a house, at least"},
          self.house_least_height_m);
    visit(Field{"house_most_height_m", "m", 1, 100, "and at most"}, self.house_most_height_m);
  }
};

/// Of the whole town; none where its blocks are smaller than its streets. They stand upright on the ground.
std::vector<UprightBox> build_houses(const StreetGridParams& streets, const TownHouseParams& params,
                                     const Hills& ground, const Rng& rng);

}  // namespace radioslam
