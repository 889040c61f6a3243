// What one robot's card captured, as one capture in the order of time, and parts of it.
//
// All packets are of one form, that of the first capture: others, of other subcarriers, are left out with a
// note. Linear in the packets but for the sorting; a part is found in logarithmic time and copied.
#pragma once

#include <string>
#include <vector>

#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// A robot's packets in time order, in one form; other forms than the first are left out.
CsiCapture merge_captures(const CsiRecording& csi, const std::string& robot, std::vector<std::string>& notes);

/// The packets from `begin` to `end`, both included.
CsiCapture captured_during(const CsiCapture& capture, Stamp begin, Stamp end);

/// What the mission tells, else what the capture does; 0 where neither tells.
double carrier_hz_of(const CsiRecording& csi, const CsiCapture& capture);

}  // namespace radioslam
