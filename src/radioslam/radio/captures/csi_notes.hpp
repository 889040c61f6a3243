// Notes for the user about CSI captures: which were ignored, which were shifted to the odometry's clock, and
// where no angle of arrival was measured, with the reason.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "radioslam/mission/mission.hpp"
#include "radioslam/radio/aoa/aoa_estimate.hpp"
#include "radioslam/radio/captures/clock_offset.hpp"

namespace radioslam {

std::string explain(TwoWayFailure reason);
std::string explain(AoaFailure reason);

/// Notes a missing WiFi channel, a missing MAC address, and packets whose sender is no robot of the mission.
void note_missing_csi(const Mission& mission, const Robot& robot, const CsiCapture& capture,
                      std::vector<std::string>& notes);

/// Note that the robot's captures were shifted to its odometry's clock.
std::string note_of_clock(const std::string& robot, const ClockOffset& clock);

/// Number of windows without an AoA estimate, by receiver, transmitter and reason.
using CsiRefusals = std::map<std::tuple<std::size_t, std::size_t, std::string>, std::size_t>;

void note_refusals(const Mission& mission, const CsiRefusals& refusals, std::vector<std::string>& notes);

}  // namespace radioslam
