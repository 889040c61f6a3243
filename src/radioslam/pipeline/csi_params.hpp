// How a mission's captures are measured (csi_stage.hpp): pieces of way, stillness, clocks, directions.
#pragma once

#include "radioslam/base/fields.hpp"
#include "radioslam/radio/arrival_estimate.hpp"

namespace radioslam {

struct CsiStageParams {
  double window_m = 1;           ///< way of one measurement
  double window_turn_rad = 1.5;  ///< turn of one measurement of a pair of antennas
  double still_m = 0.005;        ///< the other end may move so far meanwhile: a tenth of a wavelength
  bool clock_offset = true;      ///< captures' stamps are moved to the odometry's clock, where it shows
  ArrivalParams arrival;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"window_m", "m", 0.1, 100, "way of one measurement"}, self.window_m);
    visit(Field{"window_turn_rad", "rad", 0.1, 7, "turn of one measurement by two antennas"},
          self.window_turn_rad);
    visit(Field{"still_m", "m", 0, 1, "the other end may move so far during a measurement"}, self.still_m);
    visit(Field{"clock_offset", "", 0, 0, "estimate each robot's clock offset, and undo it where it shows"},
          self.clock_offset);
    ArrivalParams::visit_fields(self.arrival, visit);
  }
};

}  // namespace radioslam
