// What a user is told about captures of channel state information: which took no part, which were moved to
// another clock, and where no direction was measured, with the reason.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "radioslam/mission/mission.hpp"
#include "radioslam/radio/arrival_estimate.hpp"
#include "radioslam/radio/clock_offset.hpp"

namespace radioslam {

std::string explain(NoTwoWay reason);
std::string explain(NoArrival reason);

/// A robot's capture without a channel, without an address of its card, or with packets of no robot.
void note_what_is_missing(const Mission& mission, const Robot& robot, const CsiCapture& capture,
                          std::vector<std::string>& notes);

/// That this robot's captures were moved to its odometry's clock.
std::string note_of_clock(const std::string& robot, const ClockOffset& clock);

/// Pieces of way or turns without a direction, by receiver, transmitter and reason.
using CsiRefusals = std::map<std::tuple<std::size_t, std::size_t, std::string>, std::size_t>;

void note_refusals(const Mission& mission, const CsiRefusals& refusals, std::vector<std::string>& notes);

}  // namespace radioslam
