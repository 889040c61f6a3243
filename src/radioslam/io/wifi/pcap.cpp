#include "radioslam/io/wifi/pcap.hpp"

#include <algorithm>

#include "radioslam/base/units.hpp"

namespace radioslam {
namespace {

constexpr std::uint32_t kMicrosecondMagic = 0xa1b2c3d4, kNanosecondMagic = 0xa1b23c4d;
constexpr std::size_t kFileHeader = 24, kPacketHeader = 16;
constexpr std::size_t kMaxPacket = 262'144;  // libpcap's own limit
constexpr std::uint32_t kEthernet = 1, kLinuxCooked = 113;
constexpr std::size_t kEthernetHeader = 14, kLinuxCookedHeader = 16;
constexpr std::uint16_t kIpv4Type = 0x0800, kFragmentBits = 0x3fff;
constexpr std::size_t kMinIpv4Header = 20, kUdpHeader = 8;
constexpr std::uint8_t kUdpProtocol = 17;

std::uint32_t magic(std::string_view bytes, ByteOrder order) {
  return bytes.size() < 4 ? 0 : ByteView(bytes, order).u32(0);
}

bool is_pcap_of(std::string_view bytes, ByteOrder order) {
  return magic(bytes, order) == kMicrosecondMagic || magic(bytes, order) == kNanosecondMagic;
}

ByteOrder order_of(std::string_view bytes) {
  return is_pcap_of(bytes, ByteOrder::kBig) ? ByteOrder::kBig : ByteOrder::kLittle;
}

/// The UDP payload of an IPv4 packet to this port.
std::optional<std::string_view> payload_of_ipv4(std::string_view packet, std::uint16_t port) {
  const ByteView ip(packet, ByteOrder::kBig);
  if (packet.size() < kMinIpv4Header || ip.u8(0) >> 4U != 4) return std::nullopt;
  const std::size_t header = 4 * std::size_t{ip.u8(0) & 0xfU};
  const bool is_fragment = (ip.u16(6) & kFragmentBits) != 0;
  if (header < kMinIpv4Header || packet.size() < header + kUdpHeader || is_fragment ||
      ip.u8(9) != kUdpProtocol || ip.u16(header + 2) != port)
    return std::nullopt;
  const std::size_t length = ip.u16(header + 4);
  if (length < kUdpHeader) return std::nullopt;
  return packet.substr(header + kUdpHeader, length - kUdpHeader);
}

}  // namespace

bool is_pcap(std::string_view bytes) {
  return is_pcap_of(bytes, ByteOrder::kLittle) || is_pcap_of(bytes, ByteOrder::kBig);
}

PcapReader::PcapReader(const std::string& name, std::string_view bytes)
    : name_(name), view_(bytes, order_of(bytes)), bytes_(bytes) {
  if (bytes.empty()) throw InputError(name, 0, "the file is empty");
  if (!is_pcap(bytes)) fail("not a pcap file");
  if (bytes.size() < kFileHeader) fail("the header of the pcap file is truncated");
  fraction_ns_ = view_.u32(0) == kNanosecondMagic ? 1 : kNanosecondsPerMicrosecond;
  const std::uint32_t link = view_.u32(20);
  if (link != kEthernet && link != kLinuxCooked)
    fail("unsupported link type " + std::to_string(link) +
         "; Ethernet (1) and Linux cooked (113) are supported");
  link_header_ = link == kEthernet ? kEthernetHeader : kLinuxCookedHeader;
  at_ = kFileHeader;
}

std::optional<PcapPacket> PcapReader::next() {
  const std::size_t left = bytes_.size() - at_;
  torn_ = left > 0 && left < kPacketHeader;
  if (left < kPacketHeader) return std::nullopt;
  const std::size_t length = view_.u32(at_ + 8);
  if (length > kMaxPacket)
    fail("implausible packet length of " + std::to_string(length) + " bytes", InputError::Kind::kUnit);
  const std::int64_t fraction_ns = view_.u32(at_ + 4) * fraction_ns_;
  if (fraction_ns >= kNanosecondsPerSecond)
    fail("the fraction of the stamp, " + std::to_string(fraction_ns) + " ns, exceeds one second");
  torn_ = length > left - kPacketHeader;
  if (torn_) return std::nullopt;
  PcapPacket packet;
  packet.stamp = {view_.u32(at_) * kNanosecondsPerSecond + fraction_ns};
  packet.at = at_ + kPacketHeader;
  packet.bytes = bytes_.substr(packet.at, length);
  at_ = packet.at + length;
  return packet;
}

std::optional<std::string_view> PcapReader::udp_payload(const PcapPacket& packet, std::uint16_t port) const {
  if (packet.bytes.size() < link_header_) return std::nullopt;
  if (ByteView(packet.bytes, ByteOrder::kBig).u16(link_header_ - 2) != kIpv4Type) return std::nullopt;
  return payload_of_ipv4(packet.bytes.substr(link_header_), port);
}

void PcapReader::fail(const std::string& reason, InputError::Kind kind) const {
  throw InputError(name_, 0, "at byte " + std::to_string(at_) + ": " + reason, kind);
}

}  // namespace radioslam
