// Single readings that no unit can have measured, or that their neighbours speak against.
//
//   left out:  not a number, or beyond what units measure
//              |x - m| > jump + spreads * median |x_k - m| in any component, m the median over the reading
//              and `kNeighbours` on either side
// A real blow lasts for longer than one reading. Where more than `most_share` would have to go it is not
// single readings that are wrong, and all are kept for others to judge.
// Cost: linear in the readings.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/mission/inertial.hpp"

namespace radioslam {

struct WildReadingParams {
  double most_force_mps2 = 2000;
  double most_rate_radps = 200;
  double jump_mps2 = 30;
  double jump_radps = 5;
  double spreads = 10;
  double most_share = 0.05;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"most_force_mps2", "m/s^2", 20, 1e6, "no unit measures more: 200 g"}, self.most_force_mps2);
    visit(Field{"most_rate_radps", "rad/s", 1, 1e5, "likewise, of turns"}, self.most_rate_radps);
    visit(Field{"jump_mps2", "m/s^2", 0, 1e6, "from the neighbours, that one reading may have"},
          self.jump_mps2);
    visit(Field{"jump_radps", "rad/s", 0, 1e5, "likewise, of turns"}, self.jump_radps);
    visit(Field{"spreads", "", 0, 1e6, "of the neighbours, on top of that jump"}, self.spreads);
    visit(Field{"most_share", "", 0, 1, "of the readings; where more are wild, all of them are kept"},
          self.most_share);
  }
};

struct TameReadings {
  std::vector<InertialSample> samples;
  std::size_t left_out = 0;
};

TameReadings leave_out_wild(const std::vector<InertialSample>& samples, const WildReadingParams& params);

}  // namespace radioslam
