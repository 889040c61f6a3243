// Synthetic packets with radiotap headers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/csi/pcap_bytes.hpp"

namespace radioslam {

/// A header with these `present` words and fields.
inline std::string radiotap(const std::vector<std::uint32_t>& present, const std::string& fields) {
  std::string header = std::string(2, '\0') + number_bytes(4 + 4 * present.size() + fields.size(), 2);
  for (const std::uint32_t word : present) header += number_bytes(word, 4);
  return header + fields;
}

/// A header with a channel and a level.
inline std::string radiotap(std::uint16_t frequency_mhz, int signal_dbm) {
  return radiotap({0x28},
                  number_bytes(frequency_mhz, 2) + number_bytes(0, 2) + static_cast<char>(signal_dbm));
}

/// A MAC address that ends with this byte.
inline std::string address_bytes(char last) { return std::string("\x02\0\0\0\0", 5) + last; }

/// The first 24 bytes of an 802.11 frame.
inline std::string frame_bytes(unsigned type, unsigned subtype, char sender, char third) {
  return std::string(1, static_cast<char>(subtype << 4U | type << 2U)) + std::string(3, '\0') +
         std::string(6, '\xff') + address_bytes(sender) + address_bytes(third) + std::string(2, '\0');
}

inline std::string beacon_bytes(char bssid) {
  return frame_bytes(0, 8, bssid, bssid) + std::string(12, '\0');
}

}  // namespace radioslam
