// Merges a robot's CSI captures into one in time order, and extracts time ranges of it.
//
// Captures whose subcarriers differ from the first one's are skipped with a note. Merging sorts the packets;
// a time range is found in logarithmic time and copied.
#pragma once

#include <string>
#include <vector>

#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// A robot's packets in time order; captures with other subcarriers than the first are skipped.
CsiCapture merge_captures(const CsiRecording& csi, const std::string& robot, std::vector<std::string>& notes);

/// The packets between `begin` and `end`, both included.
CsiCapture captured_during(const CsiCapture& capture, Stamp begin, Stamp end);

/// Carrier frequency by the mission, else by the capture; 0 where neither has it.
double carrier_hz_of(const CsiRecording& csi, const CsiCapture& capture);

}  // namespace radioslam
