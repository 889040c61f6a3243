// Channel state information of a mission becomes angles of arrival between its robots.
//
// Where the other robot answered from one place, the product both ways is measured over each piece of the
// way; where it moved too, and the receiver has two antennas, the antennas against each other over each
// turn. Directions are of the body at the measurement's stamp: where the wave's bend tells how far its
// source is, what the body is away from the array's centre is taken into account. A path has an elevation in
// a mission in space where the way left its plane and tells it nearly as well as the azimuth; its sigma is
// then the larger of the two. What was not measured is noted by its reason.
//
// Captures and odometry may be written by two clocks: where a robot stopped or started while another answered
// and the estimated offset is sure, its captures' stamps are moved by it, with a note.
#pragma once

#include <string>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/radio/arrival_estimate.hpp"
#include "radioslam/results/results.hpp"

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

/// What the captures gave.
struct MeasuredCsi {
  std::vector<ArrivalMeasurement> arrivals;     ///< in the order of time
  std::vector<MeasuredArrivalResult> profiles;  ///< likewise, one each
  std::vector<std::string> notes;               ///< what took no part, and why
};

/// Nothing for a mission without captures.
MeasuredCsi measure_csi(const Mission& mission, const CsiStageParams& params, const Progress& progress);

/// Where the estimate has the transmitter, for each profile whose robots it covers.
void add_estimated_azimuths(std::vector<MeasuredArrivalResult>& profiles,
                            const std::vector<RobotResult>& robots);

}  // namespace radioslam
