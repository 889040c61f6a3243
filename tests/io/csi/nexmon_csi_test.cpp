#include "radioslam/io/csi/nexmon_csi.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "io/csi/pcap_bytes.hpp"
#include "io/recorded_data.hpp"
#include "io/refusal.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {
namespace {

constexpr std::uint16_t kChip43455c0 = 101, kChip4358 = 3, kChip4366c0 = 106;
constexpr std::uint16_t kChannel42At80 = 0xe02a, kChannel38At40 = 0xd826, kChannel6At20 = 0x1006;

/// The value of core c, stream s and subcarrier k: all different, with both signs.
int made_real_part(int c, int s, int k) { return 20 * k - 3 + 5000 * c + s; }
int made_imaginary_part(int c, int s, int k) { return 7 - 30 * k - 5000 * s - c; }

std::string whole_numbers(int real, int imaginary) {
  return number_bytes(static_cast<std::uint16_t>(real), 2) +
         number_bytes(static_cast<std::uint16_t>(imaginary), 2);
}

struct MadeRecord {
  int core = 0, stream = 0;
  std::uint16_t sequence = 0x0120, chanspec = kChannel42At80, chip = kChip43455c0;
  int subcarriers = 256;
  std::string said = std::string("\xc6\x08", 2);  // -58 dBm, data

  std::string bytes() const {
    std::string out = number_bytes(0x1111, 2) + said + std::string("\x98\xde\xd0\x48\x92\x66", 6) +
                      number_bytes(sequence, 2) +
                      number_bytes(static_cast<std::uint64_t>(core | stream << 3), 2) +
                      number_bytes(chanspec, 2) + number_bytes(chip, 2);
    for (int n = 0; n < subcarriers; ++n) {
      const int k = n < subcarriers / 2 ? n : n - subcarriers;
      out += whole_numbers(made_real_part(core, stream, k), made_imaginary_part(core, stream, k));
    }
    return out;
  }
};

/// A capture of records 0.1 ms apart.
class Capture {
 public:
  Capture& add(const std::string& record) {
    bytes_ += style_.packet(1'600'000'000, microseconds_, ethernet(datagram(record)));
    microseconds_ += 100;
    return *this;
  }
  Capture& add(const MadeRecord& record) { return add(record.bytes()); }
  Capture& wait(std::uint32_t microseconds) {
    microseconds_ += microseconds;
    return *this;
  }
  const std::string& bytes() const { return bytes_; }
  CsiCapture read() const { return read_nexmon_csi("x.pcap", bytes_); }

 private:
  PcapStyle style_;
  std::string bytes_ = style_.header();
  std::uint32_t microseconds_ = 0;
};

TEST(NexmonCsi, ReadsWholeNumbers) {
  const CsiCapture capture = Capture().wait(355'509).add(MadeRecord()).read();
  EXPECT_EQ(capture.carrier_hz, 5210e6);
  EXPECT_EQ(capture.bandwidth_hz, 80e6);
  EXPECT_TRUE(capture.warnings.empty());
  ASSERT_EQ(capture.packets.size(), 1U);
  const CsiPacket& packet = capture.packets.front();
  EXPECT_EQ(packet.stamp.ns, 1'600'000'000'355'509'000);
  EXPECT_EQ(packet.clock_us, static_cast<std::uint32_t>(1'600'000'000'355'509));
  EXPECT_EQ(packet.sender, MacAddress{0x98ded0489266});
  EXPECT_EQ(packet.counter, 0x0120U);
  EXPECT_EQ(packet.rssi, (std::array{-58, 0, 0}));
  EXPECT_EQ(packet.noise_dbm, -127);
  ASSERT_EQ(packet.channel.cols(), 241);
  ASSERT_EQ(capture.subcarrier_hz.size(), 241U);
  for (Eigen::Index column = 0; column < 241; ++column) {
    const int k = static_cast<int>(capture.subcarrier_hz[static_cast<std::size_t>(column)] / 312.5e3);
    EXPECT_EQ(packet.channel(0, column),
              std::complex<float>(static_cast<float>(made_real_part(0, 0, k)),
                                  static_cast<float>(made_imaginary_part(0, 0, k))));
  }
}

TEST(NexmonCsi, LeavesOutTheSubcarriersThatCarryNothing) {
  const auto numbers = [](const MadeRecord& record) {
    std::vector<int> k;
    for (const double hz : Capture().add(record).read().subcarrier_hz)
      k.push_back(static_cast<int>(hz / 312.5e3));
    return k;
  };
  const auto expect = [](const std::vector<int>& k, int furthest, std::size_t count, bool has_2) {
    EXPECT_EQ(k.size(), count);
    EXPECT_EQ(k.front(), -furthest);
    EXPECT_EQ(k.back(), furthest);
    EXPECT_TRUE(std::is_sorted(k.begin(), k.end()));
    EXPECT_EQ(std::count(k.begin(), k.end(), 2) == 1, has_2);
    EXPECT_EQ(std::count(k.begin(), k.end(), 0), 0);
  };
  MadeRecord old;
  old.said = std::string("\x11\x11", 2);
  expect(numbers(MadeRecord()), 122, 241, false);  // +2 is overwritten
  expect(numbers(old), 122, 242, true);
  const MadeRecord wide{.chanspec = kChannel38At40, .subcarriers = 128};
  expect(numbers(wide), 58, 113, false);
  const MadeRecord narrow{.chanspec = kChannel6At20, .subcarriers = 64};
  expect(numbers(narrow), 26, 52, true);
}

TEST(NexmonCsi, KnowsTheCarrierOfAChanspec) {
  const auto carrier = [](std::uint16_t chanspec, int subcarriers) {
    return *Capture().add(MadeRecord{.chanspec = chanspec, .subcarriers = subcarriers}).read().carrier_hz;
  };
  EXPECT_EQ(carrier(kChannel6At20, 64), 2437e6);
  EXPECT_EQ(carrier(0x100e, 64), 2484e6);
  EXPECT_EQ(carrier(0x1803, 128), 2422e6);
  EXPECT_EQ(carrier(kChannel38At40, 128), 5190e6);
  EXPECT_EQ(carrier(0xe29b, 256), 5775e6);
}

/// A value of the 4366c0 from its fields.
std::uint32_t long_float(bool minus_r, unsigned r, bool minus_i, unsigned i, int exponent) {
  return (minus_r ? 1U << 29U : 0) | r << 18U | (minus_i ? 1U << 17U : 0) | i << 6U |
         (static_cast<unsigned>(exponent) & 63U);
}
std::uint32_t short_float(bool minus_r, unsigned r, bool minus_i, unsigned i, int exponent) {
  return (minus_r ? 1U << 22U : 0) | r << 14U | (minus_i ? 1U << 13U : 0) | i << 5U |
         (static_cast<unsigned>(exponent) & 31U);
}

std::complex<float> value_at_subcarrier_1(std::uint16_t chip, std::uint32_t word) {
  MadeRecord record{.chanspec = kChannel6At20, .chip = chip, .subcarriers = 64};
  const std::string bytes = record.bytes();
  const CsiCapture capture =
      Capture().add(bytes.substr(0, 18 + 4) + number_bytes(word, 4) + bytes.substr(18 + 8)).read();
  return capture.packets.front().channel(0, 26);
}

TEST(NexmonCsi, UnpacksFloats) {
  using Complex = std::complex<float>;
  EXPECT_EQ(value_at_subcarrier_1(kChip4366c0, long_float(false, 2047, true, 1, 0)), Complex(2047, -1));
  EXPECT_EQ(value_at_subcarrier_1(kChip4366c0, long_float(true, 3, false, 1024, -17)),
            Complex(-3.0F / 131072, 1024.0F / 131072));
  EXPECT_EQ(value_at_subcarrier_1(kChip4366c0, long_float(false, 1, false, 0, 31)),
            Complex(2147483648.0F, 0));
  EXPECT_EQ(value_at_subcarrier_1(kChip4366c0, long_float(false, 1, false, 0, -32)),
            Complex(1.0F / 4294967296.0F, 0));
  for (const std::uint16_t chip : {kChip4358, std::uint16_t{0xdead}}) {
    EXPECT_EQ(value_at_subcarrier_1(chip, short_float(true, 255, false, 1, 15)),
              Complex(-255 * 32768.0F, 32768));
    EXPECT_EQ(value_at_subcarrier_1(chip, short_float(false, 5, true, 6, -16)),
              Complex(5.0F / 65536, -6.0F / 65536));
  }
}

TEST(NexmonCsi, PutsCoresAndStreamsTogether) {
  Capture made;
  for (std::uint16_t sequence = 0x10; sequence <= 0x30; sequence += 0x10)
    for (const int stream : {0, 1})
      for (const int core : {3, 0, 2})
        made.add(MadeRecord{.core = core, .stream = stream, .sequence = sequence});
  const CsiCapture capture = made.read();
  ASSERT_EQ(capture.packets.size(), 3U);
  for (const CsiPacket& packet : capture.packets) {
    ASSERT_EQ(packet.antennas, 3);
    ASSERT_EQ(packet.streams, 2);
    const int cores[] = {0, 2, 3};
    for (int stream = 0; stream < 2; ++stream)
      for (int antenna = 0; antenna < 3; ++antenna)
        EXPECT_EQ(packet.channel(3 * stream + antenna, 0),
                  std::complex<float>(static_cast<float>(made_real_part(cores[antenna], stream, -122)),
                                      static_cast<float>(made_imaginary_part(cores[antenna], stream, -122))));
  }
  EXPECT_EQ(capture.packets[1].counter, 0x20U);
  EXPECT_EQ(capture.packets[1].stamp.ns, 1'600'000'000'000'600'000);
}

TEST(NexmonCsi, ReadsCoresInEitherByteOrder) {
  std::string second = MadeRecord{.core = 1}.bytes();
  std::swap(second[12], second[13]);
  EXPECT_EQ(Capture().add(MadeRecord()).add(second).read().packets.front().antennas, 2);
}

TEST(NexmonCsi, SeparatesFramesWithoutNumbers) {
  MadeRecord record{.sequence = 0, .said = std::string("\xc6\x94", 2)};  // a block acknowledgement
  const CsiCapture one_core = Capture().add(record).add(record).add(record).read();
  EXPECT_EQ(one_core.packets.size(), 3U);
  EXPECT_EQ(one_core.packets[0].counter, std::nullopt);
  MadeRecord second = record;
  second.core = 1;
  // Lost are the second core's record of the first frame and the first core's of the next: neither frame is
  // complete.
  const CsiCapture two_cores = Capture()
                                   .add(record)
                                   .wait(10'000)
                                   .add(second)
                                   .wait(10'000)
                                   .add(record)
                                   .add(second)
                                   .wait(10'000)
                                   .add(record)
                                   .add(second)
                                   .read();
  EXPECT_EQ(two_cores.packets.size(), 2U);
  ASSERT_EQ(two_cores.warnings.size(), 1U);
  EXPECT_EQ(two_cores.warnings[0],
            "x.pcap: 2 frames whose channel, cores or streams differ from most frames are left out");
}

TEST(NexmonCsi, KeepsTheChannelThatMostWasMeasuredOn) {
  const MadeRecord narrow{.chanspec = kChannel6At20, .subcarriers = 64};
  const CsiCapture capture = Capture().add(narrow).add(MadeRecord()).add(narrow).read();
  EXPECT_EQ(capture.packets.size(), 1U);
  EXPECT_EQ(capture.bandwidth_hz, 80e6);
  EXPECT_EQ(capture.warnings.size(), 1U);
}

TEST(NexmonCsi, LeavesOutOtherAndTruncatedPackets) {
  const MadeRecord strange{.chip = 999};
  const std::string is_truncated = MadeRecord().bytes().substr(0, 18 + 1000);
  const CsiCapture capture =
      Capture().add("something else").add(MadeRecord()).add(strange).add(is_truncated).read();
  EXPECT_EQ(capture.packets.size(), 1U);
  ASSERT_EQ(capture.warnings.size(), 2U);
  EXPECT_EQ(capture.warnings[0], "x.pcap: 1 packets without CSI are skipped");
  EXPECT_EQ(
      capture.warnings[1],
      "x.pcap: 2 records are left out; the first: x.pcap: at byte 1212: chip 999 is unknown; 1 (4339), 3 "
      "(4358), 101 (43455c0) and 106 (4366c0) are supported");
}

TEST(NexmonCsi, KeepsThePacketsBeforeATruncatedOne) {
  const std::string one = Capture().add(MadeRecord()).bytes();
  const std::string two = Capture().add(MadeRecord()).add(MadeRecord()).bytes();
  for (std::size_t size = one.size() + 1; size < two.size(); size += 7) {
    const CsiCapture capture = read_nexmon_csi("x.pcap", std::string_view(two).substr(0, size));
    EXPECT_EQ(capture.packets.size(), 1U);
    ASSERT_EQ(capture.warnings.size(), 1U);
    EXPECT_EQ(capture.warnings[0], "x.pcap: at byte " + std::to_string(one.size()) +
                                       ": the last packet is truncated and left out");
  }
}

TEST(NexmonCsi, RefusesWhatIsNoCapture) {
  const auto refused = [](const std::string& bytes) {
    return refusal([&] { read_nexmon_csi("x.pcap", bytes); });
  };
  EXPECT_EQ(refused(""), "x.pcap: the file is empty");
  EXPECT_EQ(refused("text"), "x.pcap: at byte 0: not a pcap file");
  EXPECT_EQ(refused(Capture().bytes()), "x.pcap: at byte 24: the pcap file contains no packet of Nexmon CSI");
  EXPECT_EQ(refused(Capture().add(MadeRecord()).bytes().substr(0, 500)),
            "x.pcap: at byte 24: the first packet is truncated");
  EXPECT_EQ(refused(Capture().add(std::string("\x11\x11", 2)).bytes()),
            "x.pcap: at byte 40: a record of only 2 bytes");
  EXPECT_EQ(refused(Capture().add(MadeRecord{.chanspec = 0x2b06}).bytes()),
            "x.pcap: at byte 40: chanspec 0x2b06 is not supported; channels of 20, 40 and 80 MHz are");
  EXPECT_EQ(refused(Capture().add(MadeRecord{.subcarriers = 64}).bytes()),
            "x.pcap: at byte 40: 256 bytes of CSI, but 1024 are expected for chanspec 0xe02a");
  EXPECT_EQ(refused(Capture().add(MadeRecord()).add(MadeRecord{.core = 1, .stream = 1}).bytes()),
            "x.pcap: no frame has a record of every stream from every core that received it");
}

TEST(NexmonCsi, ReadsRecordedCapturesWhole) {
  RADIOSLAM_RECORDED(folder, "csi_samples/csikit");
  const CsiCapture pi = read_nexmon_csi("pi", read_bytes(folder / "example_43455c0.pcap"));
  EXPECT_EQ(pi.packets.size(), 566U);
  EXPECT_TRUE(pi.warnings.empty());
  EXPECT_EQ(pi.carrier_hz, 5210e6);
  EXPECT_EQ(pi.packets.front().rssi[0], -58);
  EXPECT_EQ(pi.packets.front().counter, std::nullopt);
  const CsiCapture router = read_nexmon_csi("router", read_bytes(folder / "example_4366c0.pcap"));
  EXPECT_EQ(router.packets.size(), 293U);
  EXPECT_TRUE(router.warnings.empty());
  EXPECT_EQ(router.carrier_hz, 5530e6);
  EXPECT_EQ(router.packets.front().counter, 0xf260U);
}

/// Some values, read from the files with another program.
TEST(NexmonCsi, ReadsRecordedValues) {
  RADIOSLAM_RECORDED(folder, "csi_samples/csikit");
  const CsiCapture pi = read_nexmon_csi("pi", read_bytes(folder / "example_43455c0.pcap"));
  EXPECT_EQ(pi.packets[0].channel(0, 121), (std::complex<float>(-12, -15)));
  EXPECT_EQ(pi.packets[565].channel(0, 0), (std::complex<float>(390, 117)));
  const CsiCapture router = read_nexmon_csi("router", read_bytes(folder / "example_4366c0.pcap"));
  EXPECT_EQ(router.packets[0].channel(0, 121), (std::complex<float>(-1871 * 0x1p-18F, 0 * 0x1p-18F)));
  EXPECT_EQ(router.packets[292].channel(0, 241), (std::complex<float>(156 * 0x1p-16F, 1091 * 0x1p-16F)));
}

}  // namespace
}  // namespace radioslam
