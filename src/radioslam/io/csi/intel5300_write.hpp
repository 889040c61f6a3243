// Writes CSI captures in the Intel 5300 format (intel5300.hpp).
#pragma once

#include <string>

#include "radioslam/mission/csi.hpp"

namespace radioslam {

/// The bytes of a capture with 30 subcarriers at 20 or 40 MHz. A packet with a sender and a counter is
/// written in the variant that stores the host's time in microseconds, from 1970 to 2106; other packets are
/// written in the stock layout, which stores only the card's clock. CSI values are rounded to integers from
/// -128 to 127, other one-byte numbers are clamped. Receiver antennas and the carrier are not stored.
std::string write_intel5300(const CsiCapture& capture);

}  // namespace radioslam
