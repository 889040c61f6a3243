#include "radioslam/io/wifi/pcap.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "io/csi/pcap_bytes.hpp"
#include "io/refusal.hpp"

namespace radioslam {
namespace {

std::vector<PcapPacket> all_packets(PcapReader& reader) {
  std::vector<PcapPacket> packets;
  while (const auto packet = reader.next()) packets.push_back(*packet);
  return packets;
}

TEST(Pcap, ReadsBothByteOrdersAndBothUnitsOfTime) {
  for (const ByteOrder order : {ByteOrder::kLittle, ByteOrder::kBig})
    for (const std::uint32_t magic : {0xa1b2c3d4U, 0xa1b23c4dU}) {
      const PcapStyle style{order, magic, 1};
      const std::string bytes =
          style.header() + style.packet(1'600'000'000, 999'999, "one") + style.packet(3, 7, "");
      ASSERT_TRUE(is_pcap(bytes));
      PcapReader reader("x.pcap", bytes);
      const auto packets = all_packets(reader);
      ASSERT_EQ(packets.size(), 2U);
      EXPECT_FALSE(reader.is_truncated());
      const std::int64_t unit_ns = magic == 0xa1b2c3d4U ? 1000 : 1;
      EXPECT_EQ(packets[0].stamp.ns, 1'600'000'000'000'000'000 + 999'999 * unit_ns);
      EXPECT_EQ(packets[0].at, 40U);
      EXPECT_EQ(packets[0].bytes, "one");
      EXPECT_EQ(packets[1].stamp.ns, 3'000'000'000 + 7 * unit_ns);
      EXPECT_EQ(packets[1].bytes, "");
    }
}

TEST(Pcap, DetectsATruncatedLastPacket) {
  const PcapStyle style;
  const std::string whole = style.header() + style.packet(1, 2, "one"), last = style.packet(3, 4, "two");
  for (std::size_t cut = 1; cut < last.size(); ++cut) {
    const std::string bytes = whole + last.substr(0, cut);
    PcapReader reader("x.pcap", bytes);
    EXPECT_EQ(all_packets(reader).size(), 1U);
    EXPECT_TRUE(reader.is_truncated());
    EXPECT_EQ(reader.at(), whole.size());
  }
}

TEST(Pcap, FindsWhatUdpCarried) {
  const auto payload = [](std::uint32_t link, const std::string& packet) {
    const PcapStyle style{ByteOrder::kLittle, 0xa1b2c3d4, link};
    const std::string bytes = style.header() + style.packet(0, 0, packet);
    PcapReader reader("x.pcap", bytes);
    const auto found = reader.udp_payload(*reader.next(), 5500);
    return found ? std::optional<std::string>(*found) : std::nullopt;
  };
  EXPECT_EQ(payload(1, ethernet(datagram("hello"))), "hello");
  EXPECT_EQ(payload(113, linux_cooked(datagram("hello"))), "hello");
  EXPECT_EQ(payload(1, ethernet(datagram("hello") + "the link's padding")), "hello");
  EXPECT_EQ(payload(1, ethernet(datagram("hello")).substr(0, 14 + 28 + 2)), "he");
  EXPECT_EQ(payload(1, ethernet(datagram("hello", 5501))), std::nullopt);
  EXPECT_EQ(payload(1, ethernet(datagram("hello"), 0x86dd)), std::nullopt);
  EXPECT_EQ(payload(1, ethernet(datagram("hello")).substr(0, 40)), std::nullopt);
  EXPECT_EQ(payload(1, "x"), std::nullopt);
  std::string other = datagram("hello");
  other[9] = 6;  // TCP
  EXPECT_EQ(payload(1, ethernet(other)), std::nullopt);
  other = datagram("hello");
  other[6] = 0x20;  // more fragments follow
  EXPECT_EQ(payload(1, ethernet(other)), std::nullopt);
}

TEST(Pcap, RefusesWhatItCannotRead) {
  const PcapStyle style;
  const auto refused = [](const std::string& bytes) {
    return refusal([&] {
      PcapReader reader("x.pcap", bytes);
      all_packets(reader);
    });
  };
  EXPECT_EQ(refused(""), "x.pcap: the file is empty");
  EXPECT_EQ(refused("text"), "x.pcap: at byte 0: not a pcap file");
  EXPECT_EQ(refused(style.header().substr(0, 23)),
            "x.pcap: at byte 0: the header of the pcap file is truncated");
  EXPECT_EQ(
      refused(PcapStyle{ByteOrder::kLittle, 0xa1b2c3d4, 127}.header()),
      "x.pcap: at byte 0: unsupported link type 127; Ethernet (1) and Linux cooked (113) are supported");
  const std::string start = style.header() + style.packet(1, 2, "one");
  EXPECT_EQ(refused(start + number_bytes(0, 8) + number_bytes(262'145, 8)),
            "x.pcap: at byte 43: implausible packet length of 262145 bytes");
  EXPECT_EQ(refused(start + style.packet(1, 1'000'000, "two")),
            "x.pcap: at byte 43: the fraction of the stamp, 1000000000 ns, exceeds one second");
}

}  // namespace
}  // namespace radioslam
