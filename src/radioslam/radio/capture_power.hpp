// How strong a capture's packets were: medians over the packets.
//
// An Intel 5300 writes RSSI as a positive number in a scale of its own, from which the received power and,
// with the noise it measured, the SNR of every subcarrier follow (intel5300_power.hpp). Other cards write
// dBm, below zero, and no noise: the power alone. The effective SNR is per modulation (effective_snr.hpp). Of
// long captures packets evenly chosen count.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/mission/csi.hpp"

namespace radioslam {

struct CapturePower {
  std::size_t packets = 0;                                       ///< all of them
  std::optional<double> received_power_dbm;                      ///< absent where the card does not tell
  std::vector<std::pair<std::string, double>> effective_snr_db;  ///< by modulation; empty where not told
};

/// Of the packets from `sender`, of all where absent.
CapturePower capture_power(const CsiCapture& capture, std::optional<MacAddress> sender);

}  // namespace radioslam
