// Synthetic pcap files.
#pragma once

#include <cstdint>
#include <string>

#include "radioslam/io/text/byte_view.hpp"

namespace radioslam {

inline std::string number_bytes(std::uint64_t value, int bytes, ByteOrder order = ByteOrder::kLittle) {
  std::string out;
  for (int k = 0; k < bytes; ++k)
    out.push_back(static_cast<char>(value >> (8 * (order == ByteOrder::kBig ? bytes - 1 - k : k)) & 0xffU));
  return out;
}

/// Byte order and format of a synthetic pcap file.
struct PcapStyle {
  ByteOrder order = ByteOrder::kLittle;
  std::uint32_t magic = 0xa1b2c3d4;
  std::uint32_t link = 1;

  std::string header() const {
    return number_bytes(magic, 4, order) + number_bytes(2, 2, order) + number_bytes(4, 2, order) +
           number_bytes(0, 8, order) + number_bytes(262'144, 4, order) + number_bytes(link, 4, order);
  }
  std::string packet(std::uint32_t seconds, std::uint32_t fraction, const std::string& bytes) const {
    return number_bytes(seconds, 4, order) + number_bytes(fraction, 4, order) +
           number_bytes(bytes.size(), 4, order) + number_bytes(bytes.size(), 4, order) + bytes;
  }
};

/// IPv4 and UDP around a payload.
inline std::string datagram(const std::string& payload, std::uint16_t port = 5500) {
  const std::string ip = std::string("\x45\0", 2) + number_bytes(28 + payload.size(), 2, ByteOrder::kBig) +
                         std::string("\0\1\0\0\1\x11\0\0\x0a\x0a\x0a\x0a\xff\xff\xff\xff", 16);
  return ip + number_bytes(port, 2, ByteOrder::kBig) + number_bytes(port, 2, ByteOrder::kBig) +
         number_bytes(8 + payload.size(), 2, ByteOrder::kBig) + number_bytes(0, 2) + payload;
}

inline std::string ethernet(const std::string& payload, std::uint16_t type = 0x0800) {
  return std::string(12, 'x') + number_bytes(type, 2, ByteOrder::kBig) + payload;
}

inline std::string linux_cooked(const std::string& payload) {
  return std::string(14, 'x') + number_bytes(0x0800, 2, ByteOrder::kBig) + payload;
}

}  // namespace radioslam
