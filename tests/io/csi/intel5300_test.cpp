#include "radioslam/io/csi/intel5300.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "io/recorded_data.hpp"
#include "radioslam/base/input_error.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {
namespace {

/// Writes bits in the card's order, lowest bit of a byte first.
class BitWriter {
 public:
  void add(unsigned value, int bits) {
    for (int k = 0; k < bits; ++k, ++count_) {
      if (count_ % 8 == 0) bytes_.push_back('\0');
      bytes_.back() = static_cast<char>(static_cast<unsigned char>(bytes_.back()) |
                                        (((value >> k) & 1U) << (count_ % 8)));
    }
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  std::size_t count_ = 0;
};

std::string little_endian(std::uint64_t value, int bytes) {
  std::string out;
  for (int k = 0; k < bytes; ++k) out.push_back(static_cast<char>(value >> (8 * k) & 0xffU));
  return out;
}

/// The value of antenna a, stream s and subcarrier k: all different, with both signs.
int real_part(int a, int s, int k) { return 4 * k - 60 + a - 20 * s; }
int imaginary_part(int a, int s, int k) { return 100 - 5 * k - 10 * s - a; }

struct Record {
  int antennas = 2, streams = 3;
  unsigned order = 0b100100;  // antennas in order
  unsigned flags = 0x101;
  bool with_host = true;

  std::string channel() const {
    BitWriter bits;
    for (int k = 0; k < 30; ++k) {
      bits.add(0b101, 3);
      for (int a = 0; a < antennas; ++a)
        for (int s = 0; s < streams; ++s) {
          bits.add(static_cast<unsigned char>(real_part(a, s, k)), 8);
          bits.add(static_cast<unsigned char>(imaginary_part(a, s, k)), 8);
        }
    }
    return bits.bytes();
  }

  std::string bytes() const {
    const std::string csi = channel();
    std::string body = little_endian(4'000'000'123, 4) + little_endian(7, 2) + little_endian(0, 2);
    for (const int byte : {antennas, streams, 33, 21, 14, -92, 45}) body.push_back(static_cast<char>(byte));
    body.push_back(static_cast<char>(order));
    body += little_endian(csi.size(), 2) + little_endian(flags, 2);
    if (with_host)
      body += little_endian(1'624'839'918, 4) + little_endian(625'174, 4) +
              std::string("\x00\x21\x6a\x30\xd2\x3c", 6) + little_endian(77, 4);
    body += csi;
    return framed(187, body);
  }

  static std::string framed(int code, const std::string& body) {
    const std::size_t length = body.size() + 1;
    return std::string{static_cast<char>(length >> 8), static_cast<char>(length), static_cast<char>(code)} +
           body;
  }
};

void expect_refused(const std::string& bytes, const std::string& words) {
  try {
    read_intel5300("x.dat", bytes);
    ADD_FAILURE() << "read, where '" << words << "' was expected";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
}

TEST(Intel5300, ReadsBothLayouts) {
  for (const bool with_host : {true, false}) {
    Record record;
    record.with_host = with_host;
    const CsiCapture capture = read_intel5300("x.dat", record.bytes());
    ASSERT_EQ(capture.packets.size(), 1U);
    EXPECT_TRUE(capture.warnings.empty());
    const CsiPacket& packet = capture.packets.front();
    EXPECT_EQ(packet.clock_us, 4'000'000'123U);
    EXPECT_EQ(packet.rssi, (std::array{33, 21, 14}));
    EXPECT_EQ(packet.noise_dbm, -92);
    EXPECT_EQ(packet.gain_control_db, 45);
    EXPECT_EQ(packet.antennas, 2);
    EXPECT_EQ(packet.streams, 3);
    EXPECT_EQ(packet.sender, with_host ? std::optional(MacAddress{0x00216a30d23c}) : std::nullopt);
    EXPECT_EQ(packet.counter, with_host ? std::optional(77U) : std::nullopt);
    EXPECT_EQ(packet.stamp.ns, with_host ? 1'624'839'918'625'174'000 : 4'000'000'123'000);
    for (int a = 0; a < 2; ++a)
      for (int s = 0; s < 3; ++s)
        for (int k = 0; k < 30; ++k)
          EXPECT_EQ(packet.channel(2 * s + a, k),
                    std::complex<float>(static_cast<float>(real_part(a, s, k)),
                                        static_cast<float>(imaginary_part(a, s, k))));
  }
}

TEST(Intel5300, PutsTheAntennasInOrder) {
  Record record;
  record.antennas = 3;
  record.streams = 1;
  record.order = 0b010010;  // the first chain uses antenna 2, the second 0, the third 1
  const CsiPacket packet = read_intel5300("x.dat", record.bytes()).packets.front();
  EXPECT_EQ(packet.channel(2, 4).real(), real_part(0, 0, 4));
  EXPECT_EQ(packet.channel(0, 4).real(), real_part(1, 0, 4));
  EXPECT_EQ(packet.channel(1, 4).real(), real_part(2, 0, 4));
  record.order = 0b111111;  // invalid order
  EXPECT_EQ(read_intel5300("x.dat", record.bytes()).packets.front().channel(1, 4).real(), real_part(1, 0, 4));
}

TEST(Intel5300, KnowsWhereTheSubcarriersLie) {
  Record record;
  const CsiCapture narrow = read_intel5300("x.dat", record.bytes());
  record.flags |= 0x800;
  const CsiCapture wide = read_intel5300("x.dat", record.bytes());
  ASSERT_EQ(narrow.subcarrier_hz.size(), 30U);
  EXPECT_EQ(narrow.subcarrier_hz.front(), -28 * 312.5e3);
  EXPECT_EQ(narrow.subcarrier_hz[14], -312.5e3);
  EXPECT_EQ(narrow.subcarrier_hz[15], 312.5e3);
  EXPECT_EQ(narrow.subcarrier_hz.back(), 28 * 312.5e3);
  EXPECT_EQ(wide.subcarrier_hz.front(), -58 * 312.5e3);
  EXPECT_EQ(wide.subcarrier_hz.back(), 58 * 312.5e3);
}

TEST(Intel5300, SkipsOtherRecordsAndWidths) {
  Record wide;
  wide.flags |= 0x800;
  const std::string other = Record::framed(0xc1, "a packet's bytes");
  const CsiCapture capture =
      read_intel5300("x.dat", other + Record().bytes() + other + wide.bytes() + Record().bytes());
  EXPECT_EQ(capture.packets.size(), 2U);
  ASSERT_EQ(capture.warnings.size(), 1U);
  EXPECT_NE(capture.warnings[0].find("1 packets of another bandwidth"), std::string::npos);
}

TEST(Intel5300, KeepsTheRecordsBeforeATruncatedOne) {
  const std::string one = Record().bytes();
  for (std::size_t cut = 1; cut < one.size(); ++cut) {
    const CsiCapture capture = read_intel5300("x.dat", one + one.substr(0, cut));
    EXPECT_EQ(capture.packets.size(), 1U);
    ASSERT_EQ(capture.warnings.size(), 1U);
    EXPECT_NE(capture.warnings[0].find("at byte " + std::to_string(one.size())), std::string::npos);
  }
}

TEST(Intel5300, RefusesWhatIsNoCapture) {
  expect_refused("", "the file is empty");
  expect_refused(Record().bytes().substr(0, 100), "at byte 0: not a capture");
  expect_refused(Record::framed(0xc1, "x"), "at byte 0: contains no record");
  const std::string one = Record().bytes();
  const std::string place = "at byte " + std::to_string(one.size()) + ": ";
  expect_refused(one + std::string(3, '\0'), place + "a record of zero bytes");
  expect_refused(one + Record::framed(187, "short"), place + "a record of only 5 bytes");
  Record many;
  many.antennas = 4;
  expect_refused(one + many.bytes(), place + "a record of 4 antennas and 3 streams");
  std::string wrong = one;
  wrong[3 + 16] = 1;  // the length of the CSI
  expect_refused(one + wrong, "bytes for the channels of 2 antennas and 3 streams, but these need 372");
  expect_refused(one + Record::framed(187, one.substr(3, 25) + one.substr(3 + 38)),
                 place + "a header of 25 bytes");
}

TEST(Intel5300, ReadsRecordedCapturesWhole) {
  RADIOSLAM_RECORDED(folder, "csi_samples");
  const auto packets = [&](const char* file) {
    return read_intel5300(file, read_bytes(folder / file)).packets.size();
  };
  EXPECT_EQ(packets("csitool/log.all_csi.6.7.6"), 29U);
  EXPECT_EQ(packets("csiread/sample_0x1_ap.dat"), 540U);
  EXPECT_EQ(packets("csiread/sample_0x5_64_3000.dat"), 2998U);
  for (const char* file : {"csiread/ath_csi_1.dat", "csikit/HESU20_5500.csi", "csikit/example_4366c0.pcap"})
    expect_refused(read_bytes(folder / file), "at byte ");
}

TEST(Intel5300, ReadsARecordedExchange) {
  RADIOSLAM_RECORDED(folder, "wsr/raw/LOS_Set_A/0627_2D-multi-link_A_L1");
  const CsiCapture receiver = read_intel5300("rx", read_bytes(folder / "csi_rx_2021-06-27_202550.dat"));
  const CsiCapture answers = read_intel5300("tx2", read_bytes(folder / "csi_tx2_2021-06-27_202550.dat"));
  EXPECT_EQ(receiver.packets.size(), 4640U);
  EXPECT_EQ(answers.packets.size(), 1546U);
  EXPECT_EQ(receiver.warnings.size(), 1U);
  std::set<std::uint32_t> heard, shared;
  for (const CsiPacket& packet : receiver.packets)
    if (packet.sender == MacAddress{0x00216a3f175a}) heard.insert(*packet.counter);
  for (const CsiPacket& packet : answers.packets)
    if (heard.contains(*packet.counter)) shared.insert(*packet.counter);
  EXPECT_GT(shared.size(), 1480U);
}

}  // namespace
}  // namespace radioslam
