// Reads radiotap headers, which WiFi drivers put before captured packets (radiotap.org); little endian:
//
//   u8 version 0, u8 -, u16 length, u32 present [, u32 present ...], the fields that are present
//
// Bit k of `present` means that field k is present; fields are aligned to their size from the start of the
// header. Bit 31: another word follows. Bit 29: that word counts from field 0 again (values per antenna after
// those of the packet). Bit 30: that word belongs to a vendor, whose fields state their length. Reading stops
// at a field of unknown size. (libtins 4.0 reads only the first word reliably: it does not know fields from
// 22 on and misplaces the fields after a vendor's.)
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace radioslam {

/// The fields that are read; for repeated fields the first value.
struct Radiotap {
  std::size_t length = 0;  ///< offset of the 802.11 frame
  std::optional<int> signal_dbm;
  std::optional<int> frequency_mhz;
  bool bad_checksum = false;  ///< the card reported a wrong frame checksum
};

/// Nothing if the header is incomplete or its fields exceed its length.
std::optional<Radiotap> read_radiotap(std::string_view packet);

}  // namespace radioslam
