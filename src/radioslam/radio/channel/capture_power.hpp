// Received power and effective SNR of a CSI capture: medians over its packets.
//
// An Intel 5300 reports RSSI as a positive number on its own scale, from which the received power and, with
// the measured noise, the SNR of every subcarrier follow (intel5300_power.hpp). Other cards report negative
// dBm and no noise, which gives the power only. The effective SNR is per modulation (effective_snr.hpp). Long
// captures are subsampled evenly.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/mission/csi.hpp"

namespace radioslam {

struct CapturePower {
  std::size_t packets = 0;                                       ///< all packets of the sender
  std::optional<double> received_power_dbm;                      ///< absent where the card does not report it
  std::vector<std::pair<std::string, double>> effective_snr_db;  ///< by modulation; empty without noise
};

/// Power of the packets from `sender`, or of all packets where absent.
CapturePower capture_power(const CsiCapture& capture, std::optional<MacAddress> sender);

}  // namespace radioslam
