
#include <gtest/gtest.h>

#include <cmath>

#include "io/recorded_data.hpp"
#include "radioslam/io/csi/intel5300.hpp"
#include "radioslam/io/text/text.hpp"
#include "radioslam/radio/channel/capture_power.hpp"

namespace radioslam {
namespace {

/// Packet with equal coefficients.
CsiPacket packet(int antennas, int streams, std::complex<float> coefficient) {
  CsiPacket result;
  result.antennas = antennas;
  result.streams = streams;
  result.rssi = {30, 0, 0};
  result.gain_control_db = 40;
  result.noise_dbm = -90;
  result.channel.setConstant(antennas * streams, 30, coefficient);
  return result;
}

/// The first packet of the tool's own sample, as its documentation lists it: 10^3.3 + 10^3.7 + 10^4.1 =
/// 19596, 42.92 dB, minus 44 and the gain control of 38.
TEST(Intel5300Power, IsTheSumOverAntennasLessTheGain) {
  CsiPacket three = packet(3, 1, 1);
  three.rssi = {33, 37, 41};
  three.gain_control_db = 38;
  EXPECT_NEAR(*received_power_dbm(three), 42.9217 - 44 - 38, 1e-3);
  EXPECT_NEAR(*received_power_dbm(packet(1, 1, 1)), 30 - 44 - 40, 1e-9);
}

TEST(Intel5300Power, IsUnknownWithoutAnAntenna) {
  CsiPacket silent = packet(1, 1, 1);
  silent.rssi = {0, 0, 0};
  EXPECT_FALSE(received_power_dbm(silent));
  EXPECT_FALSE(channel_in_snr_units(silent));
  EXPECT_FALSE(subcarrier_snr_db(packet(1, 1, 0)));
}

/// |h|^2 = 100 corresponds to -54 dBm; noise is -90 dBm and a hundredth of the signal: SNR = 1 / (1e-3.6 +
/// 1e-2).
TEST(Intel5300Power, ScalesTheChannelToItsSnr) {
  const auto H = channel_in_snr_units(packet(1, 1, {6, 8}));
  const double expected = 1 / (std::pow(10, -3.6) + 1e-2);
  EXPECT_NEAR(std::norm((*H)(0, 7)), expected, 1e-9);
  EXPECT_NEAR(std::arg((*H)(0, 7)), std::atan2(8, 6), 1e-12);
  EXPECT_NEAR(subcarrier_snr_db(packet(1, 1, {6, 8}))->at(3), 10 * std::log10(expected), 1e-9);
}

TEST(Intel5300Power, TakesTheNominalNoiseWhereNoneWasMeasured) {
  CsiPacket unknown = packet(1, 1, {6, 8});
  unknown.noise_dbm = -127;
  EXPECT_NEAR(std::norm((*channel_in_snr_units(unknown))(0, 0)), 1 / (std::pow(10, -3.8) + 1e-2), 1e-9);
}

/// Two orthogonal streams: the card's scale compensates the halved power, the receiver halves it again. |h|^2
/// = 100 per stream, 200 in all, and quantisation is 4 of 200.
TEST(Intel5300Power, SeparatesStreams) {
  CsiPacket two = packet(2, 2, 0);
  two.channel.row(0).setConstant(10);                          // stream 0 at antenna 0
  two.channel.row(3).setConstant(std::complex<float>(0, 10));  // stream 1 at antenna 1
  const auto snr_db = subcarrier_snr_db(two);
  ASSERT_EQ(snr_db->size(), 60U);
  for (const double snr : *snr_db) EXPECT_NEAR(snr, 10 * std::log10(0.5 / (std::pow(10, -3.6) + 2e-2)), 1e-9);
}

TEST(Intel5300Power, OfARecordedCapture) {
  RADIOSLAM_RECORDED(folder, "csi_samples");
  const auto file = folder / "csitool/log.all_csi.6.7.6";
  const CsiCapture capture = read_intel5300(file.string(), read_bytes(file));
  EXPECT_NEAR(*received_power_dbm(capture.packets.front()), -39.0783, 1e-3);
  for (const CsiPacket& heard : capture.packets) {
    const auto snr_db = subcarrier_snr_db(heard);
    ASSERT_TRUE(snr_db);
    const double effective_db = effective_snr_db(*snr_db, Modulation::kQam16);
    EXPECT_GT(effective_db, 5);
    EXPECT_LT(effective_db, 45);
  }
}

TEST(CapturePower, IsTheMediansOfTheSendersPackets) {
  CsiCapture capture;
  for (const int rssi : {28, 30, 45}) {
    capture.packets.push_back(packet(1, 1, {6, 8}));
    capture.packets.back().rssi[0] = rssi;
    capture.packets.back().sender = MacAddress{7};
  }
  capture.packets.push_back(packet(1, 1, 1));
  const CapturePower power = capture_power(capture, MacAddress{7});
  EXPECT_EQ(power.packets, 3U);
  EXPECT_NEAR(*power.received_power_dbm, 30 - 44 - 40, 1e-9);
  const double flat_db = -10 * std::log10(std::pow(10, -3.6) + 1e-2);
  ASSERT_EQ(power.effective_snr_db.size(), 4U);
  for (const auto& [modulation, snr_db] : power.effective_snr_db)
    EXPECT_NEAR(snr_db, flat_db, 1e-3) << modulation << ": equals the SNR of a flat channel";
}

TEST(CapturePower, OfCardsThatWriteDbmIsThatWithoutAnSnr) {
  CsiCapture capture;
  capture.packets.push_back(packet(1, 1, {6, 8}));
  capture.packets.back().rssi = {-61, 0, 0};
  const CapturePower power = capture_power(capture, std::nullopt);
  EXPECT_NEAR(*power.received_power_dbm, -61, 1e-9);
  EXPECT_TRUE(power.effective_snr_db.empty());
  EXPECT_FALSE(capture_power({}, std::nullopt).received_power_dbm);
}

}  // namespace
}  // namespace radioslam
