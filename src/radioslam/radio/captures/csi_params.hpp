// Parameters of the AoA stage (csi_stage.hpp): measurement windows, clock offset, estimator.
#pragma once

#include "radioslam/base/fields.hpp"
#include "radioslam/radio/aoa/aoa_types.hpp"

namespace radioslam {

struct CsiStageParams {
  double window_m = 1;
  double window_turn_rad = 1.5;
  double still_m = 0.005;  ///< a tenth of a wavelength at 5 GHz
  bool clock_offset = true;
  AoaParams aoa;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(window_m, "m", 0.1, 100, "path length of the receiver per AoA measurement");
    RADIOSLAM_FIELD(window_turn_rad, "rad", 0.1, 7,
                    "rotation of the receiver per AoA measurement with two antennas");
    RADIOSLAM_FIELD(
        still_m, "m", 0, 1,
        "largest displacement of the transmitter during a measurement with a single receive antenna");
    RADIOSLAM_BASIC_FIELD(clock_offset, "", 0, 0,
                          "estimation of each robot's CSI clock offset, corrected where it is significant");
    AoaParams::visit_fields(self.aoa, visit);
  }
};

}  // namespace radioslam
