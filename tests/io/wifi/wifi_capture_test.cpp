#include "radioslam/io/wifi/wifi_capture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <sstream>

#include "io/recorded_data.hpp"
#include "io/refusal.hpp"
#include "io/wifi/radiotap_bytes.hpp"
#include "io/wifi/wifi_rows.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {
namespace {

constexpr const char* kMalformed = "packets are truncated or malformed, and left out";

const PcapStyle kMicroseconds{ByteOrder::kLittle, 0xa1b2c3d4, 127};

std::string heard(const PcapStyle& style = kMicroseconds) {
  return style.packet(100, 250'000, radiotap(2412, -50) + beacon_bytes(1)) +
         style.packet(100, 500'000, radiotap(2437, -60) + frame_bytes(0, 5, 2, 3));
}

const Rows kHeard{"100.25,02:00:00:00:00:01,2412,-50", "100.5,02:00:00:00:00:03,2437,-60"};

WifiLog read_capture(const std::string& bytes, const WifiCaptureParams& params = {}) {
  return read_wifi_capture("a.pcap", bytes, params);
}

TEST(WifiCapture, ReadsBeaconsAndProbeResponses) {
  const WifiLog log = read_capture(kMicroseconds.header() + heard());
  EXPECT_EQ(row_texts(log), kHeard);
  EXPECT_TRUE(log.counts.empty() && log.warnings.empty());
}

TEST(WifiCapture, ReadsEveryByteOrderAndNanoseconds) {
  const PcapStyle big{ByteOrder::kBig, 0xa1b2c3d4, 127};
  EXPECT_EQ(row_texts(read_capture(big.header() + heard(big))), kHeard);
  const PcapStyle fine{ByteOrder::kLittle, 0xa1b23c4d, 127};
  EXPECT_EQ(
      row_texts(read_capture(fine.header() + fine.packet(100, 1, radiotap(2412, -50) + beacon_bytes(1)))),
      (Rows{"100.000000001,02:00:00:00:00:01,2412,-50"}));
}

/// pcapng: a section header, an interface with link type 127 and microseconds, an enhanced packet.
TEST(WifiCapture, ReadsPcapng) {
  const auto block = [](std::uint32_t type, const std::string& body) {
    const std::string length = number_bytes(12 + body.size(), 4);
    return number_bytes(type, 4) + length + body + length;
  };
  std::string packet = radiotap(2412, -50) + beacon_bytes(1);
  const std::uint64_t us = 100'250'000;
  const std::string size = number_bytes(packet.size(), 4);
  packet.resize((packet.size() + 3) / 4 * 4, '\0');
  const std::string bytes =
      block(0x0a0d0d0a, number_bytes(0x1a2b3c4d, 4) + number_bytes(1, 4) + std::string(8, '\xff')) +
      block(1, number_bytes(127, 4) + number_bytes(0, 4)) +
      block(6, number_bytes(0, 4) + number_bytes(us >> 32U, 4) + number_bytes(us & 0xffffffffU, 4) + size +
                   size + packet);
  EXPECT_EQ(row_texts(read_capture(bytes)), (Rows{kHeard[0]}));
}

TEST(WifiCapture, CountsWhatItLeavesOut) {
  const auto at = [](const std::string& bytes) { return kMicroseconds.packet(100, 0, bytes); };
  const WifiLog log = read_capture(
      kMicroseconds.header() + heard() + at("") + at(radiotap(2412, -50).substr(0, 9)) +
      at(radiotap(2412, -50) + beacon_bytes(1).substr(0, 21)) + at(radiotap({0}, "") + beacon_bytes(1)) +
      at(radiotap({0x22}, "\x40\xce") + beacon_bytes(1)) +
      at(radiotap(2412, -50) + frame_bytes(1, 13, 1, 1)));
  EXPECT_EQ(row_texts(log), kHeard);
  EXPECT_EQ(log.counts,
            (std::map<std::string, std::size_t>{{kMalformed, 3},
                                                {"frames have a wrong checksum and are left out", 1},
                                                {"frames have no level and are left out", 1}}));
}

TEST(WifiCapture, InvalidSecondsAreNotTimesBefore1970) {
  const std::string packet = radiotap(2412, -50) + beacon_bytes(1);
  const WifiLog log =
      read_capture(kMicroseconds.header() + heard() + kMicroseconds.packet(0xffffffff, 0, packet) +
                   kMicroseconds.packet(0, 0, packet));
  EXPECT_EQ(row_texts(log), (Rows{kHeard[0], kHeard[1], "0,02:00:00:00:00:01,2412,-50"}));
  EXPECT_EQ(log.counts,
            (std::map<std::string, std::size_t>{{"packets have an implausible time and are left out", 1}}));
}

TEST(WifiCapture, EveryFrameThatNamesItsTransmitter) {
  WifiCaptureParams params;
  params.every_frame = true;
  const auto at = [](unsigned type, unsigned subtype) {
    return kMicroseconds.packet(100, 0, radiotap(2412, -50) + frame_bytes(type, subtype, 7, 8));
  };
  const WifiLog log = read_capture(
      kMicroseconds.header() + at(2, 8) + at(1, 11) + at(1, 13) + at(1, 12) + at(0, 4) + at(0, 8), params);
  EXPECT_EQ(row_texts(log), Rows(4, "100,02:00:00:00:00:07,2412,-50"));
}

TEST(WifiCapture, AScansLevelIsItsFramesMean) {
  WifiCaptureParams params;
  params.scan_s = 2;
  params.clock_offset_s = -100;
  const auto at = [](std::uint32_t s, char bssid, int dbm) {
    return kMicroseconds.packet(s, 0, radiotap(2412, dbm) + beacon_bytes(bssid));
  };
  EXPECT_EQ(row_texts(read_capture(kMicroseconds.header() + at(101, 1, -50) + at(100, 2, -61) +
                                       at(101, 2, -60) + at(102, 1, -40),
                                   params)),
            (Rows{"0,02:00:00:00:00:01,2412,-50", "0,02:00:00:00:00:02,2412,-60.5",
                  "2,02:00:00:00:00:01,2412,-40"}));
}

TEST(WifiCapture, TheFilesEndMayCutAPacket) {
  const std::string whole = kMicroseconds.header() + heard();
  const std::size_t first =
      kMicroseconds.header().size() + 16 + radiotap(2412, -50).size() + beacon_bytes(1).size();
  for (std::size_t length = first + 1; length < whole.size(); ++length) {
    const WifiLog log = read_capture(whole.substr(0, length));
    EXPECT_EQ(row_texts(log), (Rows{kHeard[0]}));
    ASSERT_EQ(log.warnings.size(), 1U) << length;
    EXPECT_NE(log.warnings[0].find("a.pcap: at byte " + std::to_string(length)), std::string::npos)
        << log.warnings[0];
  }
}

TEST(WifiCapture, RefusesWhatIsNoCaptureOfAMonitor) {
  expect_refusal([] { read_capture(""); }, 0, "is empty");
  expect_refusal([] { read_capture("radioslam, which is no capture"); }, 0, "at byte 4: unknown file format");
  expect_refusal([] { read_capture(kMicroseconds.header().substr(0, 20)); }, 0, "at byte 20");
  expect_refusal([] { read_capture(PcapStyle{}.header()); }, 0, "link type 1 (Ethernet)");
  expect_refusal(
      [] {
        read_capture(PcapStyle{ByteOrder::kLittle, 0xa1b2c3d4, 105}.header());
      },
      0, "link type 105 (802.11)");
  expect_refusal([] { read_capture(kMicroseconds.header() + heard() + std::string(16, '\xff')); }, 0,
                 "at byte");
  expect_refusal([] { read_wifi_capture(std::filesystem::path("/nowhere.pcap"), {}); }, 0,
                 "cannot be opened");
  expect_refusal([] { read_wifi_capture(std::filesystem::path("/"), {}); }, 0, "is a folder");
}

/// The output of tshark; nothing if it is not installed.
std::optional<std::string> tshark(const std::string& arguments) {
  if (std::system("tshark --version >/dev/null 2>&1") != 0) return std::nullopt;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(
      ::popen(("tshark " + arguments + " 2>/dev/null").c_str(), "r"), &::pclose);
  std::string out;
  std::array<char, 4096> buffer;
  for (std::size_t got = 1; got > 0;) {
    got = std::fread(buffer.data(), 1, buffer.size(), pipe.get());
    out.append(buffer.data(), got);
  }
  return out;
}

/// Converts tshark's "1498056065.722826000,90:9f:33:d9:a0:e0,2412,-47" to rows of a WiFi log; rows without a
/// level are skipped.
Rows rows_of_tshark(const std::string& printed) {
  Rows rows;
  std::istringstream lines(printed);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t comma = line.find(',');
    if (line.ends_with(',') || line.find(",,") != std::string::npos) continue;
    rows.push_back(format_stamp(*parse_stamp(line.substr(0, comma))) + line.substr(comma));
  }
  std::stable_sort(rows.begin(), rows.end(), [](const std::string& a, const std::string& b) {
    return parse_stamp(a.substr(0, a.find(',')))->ns < parse_stamp(b.substr(0, b.find(',')))->ns;
  });
  return rows;
}

struct Recording {
  const char* name;
  std::size_t beacons;
};

/// Recordings with radiotap headers, with their numbers of beacons and probe responses that have a level.
constexpr std::array<Recording, 10> kRecordings{{{"pcap_radiotap/80211-sample.pcap", 57},
                                                 {"pcap_radiotap/80211-sample1.pcap", 169},
                                                 {"pcap_radiotap/80211-sample2.pcap", 63},
                                                 {"pcap_radiotap/80211-sample3.pcap", 150},
                                                 {"pcap_radiotap/sample.pcap", 20},
                                                 {"pcap_radiotap/sample2.pcap", 307},
                                                 {"pcap_radiotap/ssid-logger_beacons.pcap", 29},
                                                 {"aircrack/test1.pcap", 3},
                                                 {"aircrack/zn2i.pcap", 1},
                                                 {"aircrack/wpa3-psk.pcap", 0}}};

TEST(WifiCapture, CountsTheBeaconsOfRecordedCaptures) {
  RADIOSLAM_RECORDED(folder, "wifi_captures");
  for (const Recording& recording : kRecordings)
    EXPECT_EQ(read_wifi_capture(folder / recording.name, {}).rows.size(), recording.beacons)
        << recording.name;
}

void expect_as_tshark(const std::filesystem::path& path, const std::string& select, const std::string& sender,
                      const WifiCaptureParams& params) {
  const auto printed = tshark("-r '" + path.string() + "' -Y '(" + select +
                              ") && !(radiotap.flags.badfcs == 1)' -T fields -E separator=, -E occurrence=f "
                              "-e frame.time_epoch -e " +
                              sender + " -e radiotap.channel.freq -e radiotap.dbm_antsignal");
  if (!printed) GTEST_SKIP() << "tshark is not installed";
  EXPECT_EQ(row_texts(join_wifi_logs({read_wifi_capture(path, params)})), rows_of_tshark(*printed)) << path;
}

class WifiCaptureRecording : public testing::TestWithParam<Recording> {};

TEST_P(WifiCaptureRecording, BeaconsEqualTsharksRowForRow) {
  RADIOSLAM_RECORDED(path, std::string("wifi_captures/") + GetParam().name);
  expect_as_tshark(path, "wlan.fc.type_subtype == 8 || wlan.fc.type_subtype == 5", "wlan.bssid", {});
}

TEST_P(WifiCaptureRecording, FramesOfEveryTransmitterEqualTsharksRowForRow) {
  RADIOSLAM_RECORDED(path, std::string("wifi_captures/") + GetParam().name);
  WifiCaptureParams params;
  params.every_frame = true;
  expect_as_tshark(path, "wlan.ta", "wlan.ta", params);
}

INSTANTIATE_TEST_SUITE_P(All, WifiCaptureRecording, testing::ValuesIn(kRecordings),
                         [](const auto& one) { return std::to_string(one.index); });

}  // namespace
}  // namespace radioslam
