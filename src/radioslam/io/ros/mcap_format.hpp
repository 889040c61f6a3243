// What MCAP files consist of (mcap.dev/spec): a magic, records of u8 opcode, u64 length and content (little
// endian), and the magic again.
#pragma once

#include <cstdint>
#include <string_view>

namespace radioslam {

inline constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";

enum McapOpcode : std::uint8_t {
  kMcapHeader = 0x01,
  kMcapFooter = 0x02,
  kMcapSchema = 0x03,
  kMcapChannel = 0x04,
  kMcapMessage = 0x05,
  kMcapChunk = 0x06,
  kMcapMessageIndex = 0x07,
  kMcapChunkIndex = 0x08,
  kMcapStatistics = 0x0b,
  kMcapSummaryOffset = 0x0e,
  kMcapDataEnd = 0x0f,
};

/// CRC-32 of these bytes behind those of which it is `before`.
std::uint32_t mcap_checksum(std::string_view bytes, std::uint32_t before = 0);

}  // namespace radioslam
