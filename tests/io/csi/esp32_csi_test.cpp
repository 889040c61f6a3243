#include "radioslam/io/csi/esp32_csi.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "esp32_text.hpp"
#include "io/recorded_data.hpp"
#include "io/refusal.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {
namespace {

CsiCapture read_lines(const std::string& text) { return read_esp32_csi("x.csv", text); }

/// Checks that the capture's first packet has the value at `place(k)` for subcarrier k.
void expect_places(const CsiCapture& capture, const std::function<int(int)>& place) {
  ASSERT_FALSE(capture.packets.empty());
  ASSERT_EQ(capture.packets[0].channel.cols(), static_cast<Eigen::Index>(capture.subcarrier_hz.size()));
  for (std::size_t column = 0; column < capture.subcarrier_hz.size(); ++column) {
    const int k = static_cast<int>(capture.subcarrier_hz[column] / 312.5e3);
    EXPECT_EQ(capture.packets[0].channel(0, static_cast<Eigen::Index>(column)),
              std::complex<float>(static_cast<float>(esp32_real(place(k))),
                                  static_cast<float>(esp32_imaginary(place(k)))))
        << "subcarrier " << k;
  }
}

void expect_columns(const CsiCapture& capture, std::size_t count, int furthest, double carrier_hz,
                    double bandwidth_hz) {
  EXPECT_EQ(capture.subcarrier_hz.size(), count);
  EXPECT_EQ(capture.subcarrier_hz.front(), -furthest * 312.5e3);
  EXPECT_EQ(capture.subcarrier_hz.back(), furthest * 312.5e3);
  EXPECT_EQ(capture.carrier_hz, carrier_hz);
  EXPECT_EQ(capture.bandwidth_hz, bandwidth_hz);
}

TEST(Esp32Csi, ReadsBothLayouts) {
  for (const Esp32Layout layout : {Esp32Layout::kTool, Esp32Layout::kEspressif}) {
    const CsiCapture capture = read_lines(Esp32Text{.layout = layout}.line());
    EXPECT_TRUE(capture.warnings.empty());
    ASSERT_EQ(capture.packets.size(), 1U);
    const CsiPacket& packet = capture.packets.front();
    EXPECT_EQ(packet.clock_us, 80'272'146U);
    EXPECT_EQ(packet.stamp.ns, 80'272'146'000);
    EXPECT_EQ(packet.sender, MacAddress{0x3c71bf6d2a78});
    EXPECT_EQ(packet.rssi, (std::array{-73, 0, 0}));
    EXPECT_EQ(packet.noise_dbm, -93);
    EXPECT_EQ(packet.antennas, 1);
    EXPECT_EQ(packet.streams, 1);
    EXPECT_EQ(packet.counter, layout == Esp32Layout::kEspressif ? std::optional(41U) : std::nullopt);
    expect_columns(capture, 56, 28, 2437e6, 20e6);
    expect_places(capture, [](int k) { return 64 + (k < 0 ? k + 64 : k); });
  }
}

TEST(Esp32Csi, FindsColumnsByTheHeader) {
  const std::string header =
      "I (12) csi: "
      "type,sequence,timestamp,mac,rssi,sig_mode,bandwidth,stbc,noise_floor,channel,secondary_channel,"
      "local_timestamp,len,first_word,data\n";
  std::string line = "CSI_DATA,5,77,3c:71:bf:6d:2a:78,-40,0,0,0,-91,11,0,-1,128,0,\"[";
  for (int n = 0; n < 64; ++n)
    line += std::to_string(esp32_imaginary(n)) + "," + std::to_string(esp32_real(n)) + (n < 63 ? "," : "]\"");
  const CsiCapture capture = read_lines(header + line);
  expect_columns(capture, 52, 26, 2462e6, 20e6);
  expect_places(capture, [](int k) { return k < 0 ? k + 64 : k; });
  EXPECT_EQ(capture.packets[0].clock_us, 4'294'967'295U);
  EXPECT_EQ(capture.packets[0].rssi[0], -40);
}

TEST(Esp32Csi, LeavesOutTheSubcarrierOfAnInvalidFirstWord) {
  const Esp32Text said{
      .layout = Esp32Layout::kEspressif, .mode = 0, .stated = 128, .values = 128, .first_word = "0"};
  Esp32Text invalid = said, tool_layout = said;
  invalid.first_word = "1";
  tool_layout.layout = Esp32Layout::kTool;
  expect_columns(read_lines(said.line()), 52, 26, 2437e6, 20e6);
  for (const Esp32Text& text : {invalid, tool_layout}) {
    const CsiCapture capture = read_lines(text.line());
    expect_columns(capture, 51, 26, 2437e6, 20e6);
    expect_places(capture, [](int k) { return k < 0 ? k + 64 : k; });
    EXPECT_EQ(capture.subcarrier_hz[26], 2 * 312.5e3);
  }
}

TEST(Esp32Csi, KnowsTheOrderBesideASecondChannel) {
  for (const int secondary : {1, 2}) {
    const CsiCapture legacy =
        read_lines(Esp32Text{.mode = 0, .secondary = secondary, .stated = 128, .values = 128}.line());
    expect_columns(legacy, 52, 26, 2437e6, 20e6);
    expect_places(legacy, [](int k) { return k + 32; });
    const CsiCapture narrow = read_lines(Esp32Text{.secondary = secondary}.line());
    expect_columns(narrow, 56, 28, 2437e6, 20e6);
    expect_places(narrow, [](int k) { return 64 + k + 32; });
    const int coded = secondary == 1 ? 376 : 380;
    const CsiCapture stbc =
        read_lines(Esp32Text{.stbc = 1, .secondary = secondary, .stated = coded, .values = coded}.line());
    expect_columns(stbc, 56, 28, 2437e6, 20e6);
    expect_places(stbc, [&](int k) { return 64 + k + (secondary == 1 ? 30 : 32); });
  }
}

TEST(Esp32Csi, ReadsPacketsOf40Megahertz) {
  for (const int secondary : {1, 2}) {
    const double carrier_hz = secondary == 1 ? 2447e6 : 2427e6;
    Esp32Text text{.bandwidth = 1, .secondary = secondary, .stated = 384, .values = 384};
    const CsiCapture plain = read_lines(text.line());
    expect_columns(plain, 114, 58, carrier_hz, 40e6);
    expect_places(plain, [](int k) { return 64 + (k < 0 ? k + 128 : k); });
    text.stbc = 1;
    text.stated = text.values = 612;
    const CsiCapture coded = read_lines(text.line());
    expect_columns(coded, 114, 58, carrier_hz, 40e6);
    expect_places(coded, [](int k) { return 64 + (k < 0 ? k + 121 : k); });
  }
}

TEST(Esp32Csi, ReadsTheLegacyFieldWhereOnlyThatIsPrinted) {
  const CsiCapture capture =
      read_lines(Esp32Text{.bandwidth = 1, .secondary = 1, .stated = 384, .values = 128}.line());
  expect_columns(capture, 52, 26, 2437e6, 20e6);
  expect_places(capture, [](int k) { return k + 32; });
}

TEST(Esp32Csi, KnowsTheCarrierOfAChannel) {
  const auto carrier = [](int channel) {
    return *read_lines(Esp32Text{.channel = channel}.line()).carrier_hz;
  };
  EXPECT_EQ(carrier(1), 2412e6);
  EXPECT_EQ(carrier(13), 2472e6);
  EXPECT_EQ(carrier(14), 2484e6);
  EXPECT_EQ(carrier(36), 5180e6);
  EXPECT_EQ(carrier(165), 5825e6);
}

TEST(Esp32Csi, KeepsTheFieldThatMostWasMeasuredWith) {
  const std::string legacy = Esp32Text{.mode = 0, .stated = 128, .values = 128}.line(),
                    high = Esp32Text{}.line();
  const CsiCapture all = read_lines(high + legacy + legacy + high);
  EXPECT_EQ(all.packets.size(), 4U);  // 4 x 51 values of the legacy field, 2 x 56 of the other field
  EXPECT_EQ(all.subcarrier_hz.size(), 51U);
  EXPECT_TRUE(all.warnings.empty());
  const std::string most = high + high + high + high;
  const CsiCapture narrow = read_lines(most + most + most + legacy);
  EXPECT_EQ(narrow.packets.size(), 12U);
  EXPECT_EQ(narrow.subcarrier_hz.size(), 56U);
  ASSERT_EQ(narrow.warnings.size(), 1U);
  EXPECT_EQ(narrow.warnings[0],
            "x.csv: 1 packets on another channel or without the most frequent training field are left out");
}

TEST(Esp32Csi, TakesTheHostsTimeWhereItWasSet) {
  const CsiCapture capture = read_lines(Esp32Text{.host_time = "1,1600000000.25"}.line());
  EXPECT_EQ(capture.packets[0].stamp.ns, 1'600'000'000'250'000'000);
  EXPECT_EQ(capture.packets[0].clock_us, 80'272'146U);
}

TEST(Esp32Csi, SkipsTheLogAndLeavesOutTruncatedLines) {
  const std::string line = Esp32Text{}.line();
  const std::string text = "rst:0x1 (POWERON_RESET)\r\n\xff\xfe\n" + line.substr(0, 200) + line +
                           "W (51) wifi: " + line + line.substr(0, 300) + "\n\n" + line.substr(0, 90);
  const CsiCapture capture = read_lines(text);
  EXPECT_EQ(capture.packets.size(), 2U);
  ASSERT_EQ(capture.warnings.size(), 2U);
  EXPECT_EQ(capture.warnings[0], "x.csv: 2 lines without CSI are skipped");
  EXPECT_EQ(capture.warnings[1],
            "x.csv: 2 lines are left out; the first: x.csv:5: the list of values is not closed");
}

TEST(Esp32Csi, ReadsUpToAnyCut) {
  const std::string line = Esp32Text{}.line();
  for (std::size_t cut = 1; cut + 2 < line.size(); cut += 11) {
    const CsiCapture capture = read_lines(line + line.substr(0, cut));
    EXPECT_EQ(capture.packets.size(), 1U);
    EXPECT_EQ(capture.warnings.size(), 1U);
  }
}

TEST(Esp32Csi, RefusesALineThatContradictsItself) {
  const auto changed = [](const std::string& from, const std::string& to) {
    std::string line = Esp32Text{}.line();
    return "log\n" + line.replace(line.find(from), from.size(), to);
  };
  const auto expect = [](const std::string& text, const std::string& words) {
    expect_refusal([&] { read_lines(text); }, 2, words);
  };
  expect(changed("3C:71", "3C71"), "'3C71:BF:6D:2A:78' is not a MAC address such as");
  expect(changed(",256,[", ",255,["), "256 values, but len is 255");
  expect(changed("[40 ", "[400 "), "value '400' is not a whole number from -128 to 127");
  expect(changed("[40 ", "[4x "), "value '4x'");
  expect(changed(",[", "["), "a comma is missing before");
  expect(changed(",6,0,8027", ",15,0,8027"), "channel 15 is not a channel of 2.4 or 5 GHz");
  expect(changed(",6,0,8027", ",6,3,8027"), "secondary_channel '3' is not a whole number from 0 to 2");
  expect(changed("-73,11,", "-73,11,11,"),
         "26 fields before the values, but 25 (ESP32-CSI-Tool) or 24 (esp-csi)");
  expect(changed("80272146", "4294967296"), "local_timestamp '4294967296'");
  expect(changed("0,80.36", "1,a80.36"), "real_timestamp 'a80.363225' is not a valid time");
  expect("log\n" + Esp32Text{.bandwidth = 1, .stated = 384, .values = 384}.line(),
         "without a secondary channel");
  for (const int values : {0, 126, 130, 254, 258})
    expect("log\n" + Esp32Text{.stated = values, .values = values}.line(),
           "values do not match any packet of this kind");
  expect("log\n" + Esp32Text{.mode = 0}.line(), "256 values do not match any packet of this kind");
}

TEST(Esp32Csi, RefusesWhatIsNoCapture) {
  const auto refused = [](const std::string& text) { return refusal([&] { read_lines(text); }); };
  EXPECT_EQ(refused(""), "x.csv: the file is empty");
  EXPECT_EQ(refused("a log\nof something else"), "x.csv: contains no line with CSI_DATA");
  EXPECT_EQ(refused("CSI_DATA,7"), "x.csv:1: the list of values is missing");
  EXPECT_EQ(
      refused(
          "type,seq,mac,rssi,rate,noise_floor,fft_gain,agc_gain,channel,local_timestamp,sig_len,rx_state,"
          "len,first_word,data\nCSI_DATA,7,1a:00:00:00:00:00,-23,11,-96,32,4,11,372852,47,0,2,0,\"[0,0]\""),
      "x.csv:2: the columns of an ESP32-C5 or -C6 are not supported: they do not define the order of the "
      "subcarriers");
  EXPECT_EQ(refused("type,secondary_channel,local_timestamp,data\nCSI_DATA,0,0,[1 2]"),
            "x.csv:2: column mac is missing");
}

TEST(Esp32Csi, ReadsRecordedCapturesWhole) {
  RADIOSLAM_RECORDED(folder, "csi_samples");
  const CsiCapture passive =
      read_esp32_csi("a.csv", read_bytes(folder / "csikit/example_100hz_pitraffic.csv"));
  EXPECT_EQ(passive.packets.size(), 833U);
  EXPECT_EQ(passive.warnings,
            (std::vector<std::string>{
                "a.csv: 1 line is left out; the first: a.csv:19: 127 values, but len is 128"}));
  expect_columns(passive, 51, 26, 2447e6, 20e6);
  const CsiCapture at_access_point = read_esp32_csi("b.csv", read_bytes(folder / "csiread/example_csi.csv"));
  EXPECT_EQ(at_access_point.packets.size(), 13U);
  EXPECT_TRUE(at_access_point.warnings.empty());
  expect_columns(at_access_point, 52, 26, 2412e6, 20e6);
}

/// Values as in the files: imaginary part first.
TEST(Esp32Csi, ReadsRecordedValues) {
  RADIOSLAM_RECORDED(folder, "csi_samples");
  const CsiPacket passive =
      read_esp32_csi("a.csv", read_bytes(folder / "csikit/example_100hz_pitraffic.csv")).packets.front();
  EXPECT_EQ(passive.channel(0, 0), std::complex<float>(-3, 19));   // -26
  EXPECT_EQ(passive.channel(0, 25), std::complex<float>(2, 26));   // -1
  EXPECT_EQ(passive.channel(0, 26), std::complex<float>(-6, 27));  // 2
  EXPECT_EQ(passive.stamp.ns, 7'313'000);
  const CsiPacket active =
      read_esp32_csi("b.csv", read_bytes(folder / "csiread/example_csi.csv")).packets.front();
  EXPECT_EQ(active.channel(0, 0), std::complex<float>(12, 23));  // -26
  EXPECT_EQ(active.channel(0, 51), std::complex<float>(1, 24));  // 26
}

}  // namespace
}  // namespace radioslam
