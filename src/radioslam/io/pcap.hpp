// Network captures in pcap's format (tcpdump -w): 24 bytes of header, then per packet u32 seconds, u32
// micro- or nanoseconds, u32 bytes captured, u32 bytes sent, and the bytes captured. The header's first
// number, a1b2c3d4 or a1b23c4d, tells byte order and unit of time; its last the kind of link.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "radioslam/base/stamp.hpp"
#include "radioslam/io/byte_view.hpp"

namespace radioslam {

bool is_pcap(std::string_view bytes);

struct PcapPacket {
  std::size_t at = 0;  ///< where its bytes start in the file
  Stamp stamp;
  std::string_view bytes;
};

/// Walks through the packets of a capture, whose bytes have to outlive it.
class PcapReader {
 public:
  /// Refuses (InputError) what is no pcap file, a header that is cut off, and links other than Ethernet and
  /// "Linux cooked" (tcpdump -i any).
  PcapReader(const std::string& name, std::string_view bytes);

  /// The next packet, nothing at the file's end. Refuses impossible lengths and times.
  std::optional<PcapPacket> next();
  /// Whether the last packet was cut off by the file's end.
  bool torn() const { return torn_; }
  /// Of the packet that follows, or that was cut off.
  std::size_t at() const { return at_; }

  /// What a UDP packet over IPv4 to this port carried, as far as captured; nothing for other packets.
  std::optional<std::string_view> udp_payload(const PcapPacket& packet, std::uint16_t port) const;

 private:
  [[noreturn]] void fail(const std::string& reason) const;

  std::string name_;
  ByteView view_;
  std::string_view bytes_;
  std::int64_t fraction_ns_ = 0;  ///< unit of the stamps' second number
  std::size_t link_header_ = 0;   ///< bytes before the IP header, its type in the last two
  std::size_t at_ = 0;
  bool torn_ = false;
};

}  // namespace radioslam
