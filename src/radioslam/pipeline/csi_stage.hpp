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
#include "radioslam/pipeline/csi_params.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// What the captures gave.
struct MeasuredCsi {
  std::vector<ArrivalMeasurement> arrivals;     ///< in the order of time
  std::vector<MeasuredArrivalResult> profiles;  ///< likewise, one each
  std::vector<std::string> notes;               ///< what took no part, and why
};

/// Nothing for a mission without captures.
MeasuredCsi measure_csi(const Mission& mission, const CsiStageParams& params, const Progress& progress);

}  // namespace radioslam
