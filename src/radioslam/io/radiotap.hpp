// The header that a WiFi card's driver puts before a packet (radiotap.org): little-endian
//
//   u8 version 0, u8 -, u16 length, u32 present [, u32 present ...], the fields that are present
//
// Bit k of `present` says that field k is there, each aligned to its own size from the header's start. Bit
// 31: another word follows; bit 29: it begins again at field 0, as for each antenna after the packet as a
// whole; bit 30: it belongs to a vendor, who says how long his fields are. A field of unknown size ends what
// can be read. libtins 4.0 reads only the first of these words safely: it jumps from the first to the last,
// does not know fields from 22 on (HE, timestamp), and takes what follows a vendor's at the wrong place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace radioslam {

/// What is read of it; of fields that are there several times, the first.
struct Radiotap {
  std::size_t length = 0;  ///< the 802.11 frame begins here
  std::optional<int> signal_dbm;
  std::optional<int> frequency_mhz;
  bool bad_checksum = false;  ///< the card found the frame's checksum wrong
};

/// Nothing where the bytes hold no whole header, or one whose fields do not fit into its length.
std::optional<Radiotap> read_radiotap(std::string_view packet);

}  // namespace radioslam
