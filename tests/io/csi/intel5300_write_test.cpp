
#include <gtest/gtest.h>

#include <cmath>

#include "io/recorded_data.hpp"
#include "radioslam/io/csi/intel5300.hpp"
#include "radioslam/io/text/text.hpp"
#include "radioslam/mission/wifi_channel.hpp"

namespace radioslam {
namespace {

/// Packets of every shape, with different numbers throughout.
CsiCapture capture(ChannelWidth width) {
  CsiCapture result;
  result.subcarrier_hz = grouped_subcarriers_hz(width);
  result.bandwidth_hz = width == ChannelWidth::k40MHz ? 40e6 : 20e6;
  int number = 0;
  const auto next = [&] { return static_cast<float>((37 * ++number) % 256 - 128); };
  for (int antennas = 1; antennas <= 3; ++antennas)
    for (int streams = 1; streams <= 3; ++streams) {
      CsiPacket& packet = result.packets.emplace_back();
      packet.stamp = {1'624'839'918'625'174'000 + std::int64_t{1000} * ++number};
      packet.clock_us = 4'294'967'295U - static_cast<unsigned>(number);
      packet.sender = MacAddress{0xfe216a30d23cU};
      packet.counter = 4'000'000'000U + static_cast<unsigned>(number);
      packet.rssi = {33, 255, 0};
      packet.noise_dbm = -127;
      packet.gain_control_db = 200;
      packet.antennas = antennas;
      packet.streams = streams;
      packet.channel.resize(antennas * streams, 30);
      for (std::complex<float>& value : packet.channel.reshaped()) {
        const float real = next(), imaginary = next();
        value = {real, imaginary};
      }
    }
  return result;
}

void expect_same(const CsiPacket& a, const CsiPacket& b) {
  EXPECT_EQ(a.stamp, b.stamp);
  EXPECT_EQ(a.clock_us, b.clock_us);
  EXPECT_EQ(a.sender, b.sender);
  EXPECT_EQ(a.counter, b.counter);
  EXPECT_EQ(a.rssi, b.rssi);
  EXPECT_EQ(a.noise_dbm, b.noise_dbm);
  EXPECT_EQ(a.gain_control_db, b.gain_control_db);
  EXPECT_EQ(a.antennas, b.antennas);
  EXPECT_EQ(a.streams, b.streams);
  EXPECT_EQ(a.channel, b.channel);
}

void expect_reads_back(const CsiCapture& written) {
  const CsiCapture read = read_intel5300("x.dat", write_intel5300(written));
  EXPECT_TRUE(read.warnings.empty());
  EXPECT_EQ(read.subcarrier_hz, written.subcarrier_hz);
  EXPECT_EQ(read.bandwidth_hz, written.bandwidth_hz);
  ASSERT_EQ(read.packets.size(), written.packets.size());
  for (std::size_t k = 0; k < read.packets.size(); ++k) expect_same(read.packets[k], written.packets[k]);
}

TEST(Intel5300Write, ReadsBackAsTheSame) {
  expect_reads_back(capture(ChannelWidth::k20MHz));
  expect_reads_back(capture(ChannelWidth::k40MHz));
}

TEST(Intel5300Write, APacketOfUnknownSenderHasTheCardsClockOnly) {
  CsiCapture stock = capture(ChannelWidth::k20MHz);
  for (CsiPacket& packet : stock.packets) {
    packet.sender.reset();
    packet.counter.reset();
    packet.stamp = {std::int64_t{packet.clock_us} * 1000};
  }
  expect_reads_back(stock);
}

TEST(Intel5300Write, RoundsAndCutsToEightBits) {
  CsiCapture one = capture(ChannelWidth::k20MHz);
  one.packets.resize(1);
  one.packets[0].channel.setConstant({1000.0F, -1000.0F});
  one.packets[0].channel(0, 3) = {2.6F, -2.6F};
  one.packets[0].rssi = {-5, 300, 7};
  const CsiPacket read = read_intel5300("x.dat", write_intel5300(one)).packets.at(0);
  EXPECT_EQ(read.channel(0, 0), std::complex<float>(127, -128));
  EXPECT_EQ(read.channel(0, 3), std::complex<float>(3, -3));
  EXPECT_EQ(read.rssi, (std::array{0, 255, 7}));
}

TEST(Intel5300Write, ReadsBackARecordedExchange) {
  RADIOSLAM_RECORDED(folder, "wsr/raw/LOS_Set_A/0627_2D-multi-link_A_L1");
  const std::string file = "csi_tx2_2021-06-27_202550.dat";
  CsiCapture recorded = read_intel5300(file, read_bytes(folder / file));
  EXPECT_GT(recorded.packets.size(), 1000U);
  expect_reads_back(recorded);
}

}  // namespace
}  // namespace radioslam
