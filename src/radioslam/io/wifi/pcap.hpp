// Reader of network captures in pcap format (tcpdump -w): a header of 24 bytes, then per packet u32 seconds,
// u32 micro- or nanoseconds, u32 captured length, u32 original length, and the captured bytes. The header's
// first number, a1b2c3d4 or a1b23c4d, gives byte order and time unit; its last number gives the link type.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "radioslam/base/input_error.hpp"
#include "radioslam/base/stamp.hpp"
#include "radioslam/io/text/byte_view.hpp"

namespace radioslam {

bool is_pcap(std::string_view bytes);

struct PcapPacket {
  std::size_t at = 0;  ///< offset of its bytes in the file
  Stamp stamp;
  std::string_view bytes;
};

/// Iterates over the packets of a capture, whose bytes must outlive the reader.
class PcapReader {
 public:
  /// Refuses (InputError) other files, a truncated header, and link types other than Ethernet and "Linux
  /// cooked" (tcpdump -i any).
  PcapReader(const std::string& name, std::string_view bytes);

  /// The next packet; nothing at the end of the file. Refuses impossible lengths and times.
  std::optional<PcapPacket> next();
  /// Whether the last packet is truncated.
  bool is_truncated() const { return torn_; }
  /// Offset of the next packet, or of the truncated one.
  std::size_t at() const { return at_; }

  /// The captured payload of a UDP packet over IPv4 to this port; nothing for other packets.
  std::optional<std::string_view> udp_payload(const PcapPacket& packet, std::uint16_t port) const;

 private:
  [[noreturn]] void fail(const std::string& reason,
                         InputError::Kind kind = InputError::Kind::kUnreadable) const;

  std::string name_;
  ByteView view_;
  std::string_view bytes_;
  std::int64_t fraction_ns_ = 0;  ///< unit of the stamps' second number
  std::size_t link_header_ = 0;   ///< bytes before the IP header; the last two are its type
  std::size_t at_ = 0;
  bool torn_ = false;
};

}  // namespace radioslam
