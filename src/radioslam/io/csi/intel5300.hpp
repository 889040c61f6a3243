// Reads captures of the Intel 5300 card written by the Linux 802.11n CSI Tool, or by its variant that also
// stores the host's time, the sender and a frame counter (Harvard-REACT's WSR toolbox). A file is a sequence
// of records:
//   u16 length of the rest (big endian), u8 code, then for code 187 (little endian)
//   u32 clock in us, u16 count, 2 bytes unused, u8 antennas, u8 streams, u8 RSSI x 3, i8 noise, u8 gain
//   control, u8 antenna order, u16 bytes of CSI, u16 rate and flags, [variant: u32 seconds, u32 microseconds,
//   6 bytes MAC, u32 counter,] CSI: for each of 30 subcarriers 3 bits to skip, then i8 real, i8 imaginary per
//   antenna and stream, the streams of one antenna together.
// Records with other codes are skipped.
#pragma once

#include <string>
#include <string_view>

#include "radioslam/mission/csi.hpp"

namespace radioslam {

/// Reads a whole capture. Refuses (InputError, with the byte offset) an empty file, one without any record of
/// the card, and inconsistent records. A truncated last record and packets of another bandwidth than the
/// first one are left out with a warning.
CsiCapture read_intel5300(const std::string& name, std::string_view bytes);

// Writes CSI captures in the Intel 5300 format.

/// The bytes of a capture with 30 subcarriers at 20 or 40 MHz. A packet with a sender and a counter is
/// written in the variant that stores the host's time in microseconds, from 1970 to 2106; other packets are
/// written in the stock layout, which stores only the card's clock. CSI values are rounded to integers from
/// -128 to 127, other one-byte numbers are clamped. Receiver antennas and the carrier are not stored.
std::string write_intel5300(const CsiCapture& capture);

}  // namespace radioslam
