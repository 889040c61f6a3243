// AoA stage: estimates angles of arrival between the robots of a mission from their CSI captures.
//
// A receiver with one antenna uses the two-way product over windows of its path in which the transmitter
// stood still; a receiver with two antennas uses their difference over windows of its rotation, however the
// transmitter moved. Directions are in the body frame at the measurement's stamp; csi_aoa.hpp has elevations
// and sigmas. Windows without an estimate are counted in a note by reason.
//
// Captures and odometry may have different clocks: where a robot stopped or started while another replied,
// the offset is estimated, and a significant one is corrected with a note.
#pragma once

#include <string>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/radio/captures/csi_params.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// AoA measurements from a mission's captures.
struct MeasuredCsi {
  std::vector<AoaMeasurement> aoa_measurements;  ///< in time order
  std::vector<MeasuredAoaResult> profiles;       ///< one per measurement, same order
  std::vector<std::string> notes;                ///< captures and windows that were not used, and why
};

/// Empty for a mission without captures.
MeasuredCsi measure_csi(const Mission& mission, const CsiStageParams& params, const Progress& progress);

}  // namespace radioslam
