// Writes captures as intel5300.hpp reads them.
#pragma once

#include <string>

#include "radioslam/mission/csi.hpp"

namespace radioslam {

/// The bytes of a capture of 30 subcarriers, 20 or 40 MHz. A packet with a sender and a counter is written in
/// the variant that stores the host's time, whole microseconds from 0 to the year 2106; another one in the
/// stock layout, which stores the card's clock alone. Channels are rounded to whole numbers from -128 to 127,
/// and numbers of one byte are cut to fit; receivers and the carrier are not stored.
std::string write_intel5300(const CsiCapture& capture);

}  // namespace radioslam
