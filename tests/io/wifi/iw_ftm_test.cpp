#include "radioslam/io/wifi/iw_ftm.hpp"

#include <gtest/gtest.h>

#include "io/refusal.hpp"

namespace radioslam {
namespace {

constexpr double kMetresPerPs = 299'792'458e-12 / 2;
const std::string kHead = "wlan0 (phy #0): Peer measurements (cookie 1):\n";
const std::string kGood = "  Peer 02:00:00:00:01:00: status=0 (SUCCESS) @8123456789 tsf=0 (final)\n    FTM\n";

IwFtmLog read_ftm(const std::string& text, const IwFtmParams& params = {}) {
  return read_iw_ftm(make_text("ftm.txt", text), params);
}

/// A successful answer followed by these lines.
IwFtmLog answer(const std::string& lines, const IwFtmParams& params = {}) {
  return read_ftm(kHead + kGood + lines, params);
}

TEST(IwFtm, TakesHalfTheRoundTrip) {
  const IwFtmLog log = answer(
      "      BURST_INDEX: 0\n      RSSI_AVG: -57\n      RTT_AVG: 26685\n      RTT_VARIANCE: 25000000\n"
      "      RTT_SPREAD: 3000\n      TX bitrate: 6.0 MBit/s\n");
  ASSERT_EQ(log.ranges.size(), 1U);
  EXPECT_NEAR(log.ranges[0].range_m, 4.0, 1e-3);  // 26.685 ns round trip of light
  EXPECT_DOUBLE_EQ(log.ranges[0].sigma_m, 5000 * kMetresPerPs);
  EXPECT_EQ(log.ranges[0].bssid, "02:00:00:00:01:00");
  EXPECT_EQ(log.ranges[0].stamp.ns, 8123456789);
  EXPECT_EQ(log.failed + log.implausible + log.timeless + log.disagreeing, 0U);
}

TEST(IwFtm, TakesMillimetresWhereThereIsNoTime) {
  const IwFtmLog log = answer("      DIST_AVG: 4706\n      DIST_VARIANCE: 640000\n");
  ASSERT_EQ(log.ranges.size(), 1U);
  EXPECT_DOUBLE_EQ(log.ranges[0].range_m, 4.706);
  EXPECT_DOUBLE_EQ(log.ranges[0].sigma_m, 0.8);
}

TEST(IwFtm, TheTimeDecidesWhereADriverReportsCentimetres) {
  const IwFtmLog right = answer("      RTT_AVG: 26685\n      DIST_AVG: 4010\n");
  EXPECT_EQ(right.disagreeing, 0U);
  const IwFtmLog centimetres = answer("      RTT_AVG: 26685\n      DIST_AVG: 401\n");
  EXPECT_NEAR(centimetres.ranges.at(0).range_m, 4.0, 1e-3);
  EXPECT_EQ(centimetres.disagreeing, 1U);
}

TEST(IwFtm, BoundsTheSigma) {
  EXPECT_EQ(answer("      RTT_AVG: 26685\n").ranges.at(0).sigma_m, 1.0);
  EXPECT_EQ(answer("      RTT_AVG: 26685\n      RTT_VARIANCE: 0\n").ranges.at(0).sigma_m, 1.0);
  EXPECT_EQ(answer("      RTT_AVG: 26685\n      RTT_VARIANCE: 10000\n").ranges.at(0).sigma_m, 0.3);
}

TEST(IwFtm, BelowZeroIsNearUpToALimit) {
  EXPECT_EQ(answer("      RTT_AVG: -900\n").ranges.at(0).range_m, 0);
  const IwFtmLog far_below = answer("      DIST_AVG: -5001\n");
  EXPECT_TRUE(far_below.ranges.empty());
  EXPECT_EQ(far_below.implausible, 1U);
  EXPECT_EQ(answer("      DIST_AVG: 10000001\n").implausible, 1U);
}

TEST(IwFtm, CountsWhatFailed) {
  const IwFtmLog log = read_ftm(
      kHead + "  Peer 02:00:00:00:01:00: status=2 (TIMEOUT) @81 - no data!\n" +
      "  Peer 02:00:00:00:02:00: no response!\n" +
      "  Peer 02:00:00:00:03:00: status=0 (SUCCESS) @82\n    FTM failed: PEER_BUSY (6) retry after 3s\n" +
      "  Peer 02:00:00:00:04:00: status=0 (SUCCESS) @83\n    FTM\n      BURST_INDEX: 0\n" +
      "  Peer 02:00:00:00:05:00: failed to parse response!\n" + kGood + "      RTT_AVG: 26685\n" +
      "wlan0 (phy #0): peer measurement complete\n");
  EXPECT_EQ(log.failed, 5U);
  EXPECT_EQ(log.ranges.size(), 1U);
}

TEST(IwFtm, TheBootClockBecomesTheHostsWithoutTheDelayOfPrinting) {
  const auto event = [](const char* printed, const char* measured) {
    return std::string(printed) + ": " + kHead + "  Peer 02:00:00:00:01:00: status=0 (SUCCESS) @" + measured +
           "\n    FTM\n      RTT_AVG: 26685\n";
  };
  // Printed 0.3 s and 0.1 s late; the third line has no host time.
  const IwFtmLog log =
      read_ftm(event("1000.300000", "5000000000") + event("1001.100000", "6000000000") + kHead +
               "  Peer 02:00:00:00:01:00: status=0 (SUCCESS) @4000000000\n    FTM\n"
               "      RTT_AVG: 26685\n");
  ASSERT_EQ(log.ranges.size(), 3U);
  EXPECT_EQ(log.ranges[0].stamp.ns, 999'100'000'000);
  EXPECT_EQ(log.ranges[1].stamp.ns, 1'000'100'000'000);
  EXPECT_EQ(log.ranges[2].stamp.ns, 1'001'100'000'000);
}

TEST(IwFtm, AddsTheOffsetOfTheClock) {
  IwFtmParams params;
  params.clock_offset_s = -2.5;
  EXPECT_EQ(answer("      RTT_AVG: 26685\n", params).ranges.at(0).stamp.ns, 8123456789 - 2'500'000'000);
}

TEST(IwFtm, WithoutATimeThereIsNoRange) {
  const IwFtmLog log =
      read_ftm(kHead + "  Peer 02:00:00:00:01:00: status=0 (SUCCESS)\n    FTM\n      RTT_AVG: 26685\n");
  EXPECT_TRUE(log.ranges.empty());
  EXPECT_EQ(log.timeless, 1U);
}

TEST(IwFtm, TakesAddressesInCapitals) {
  EXPECT_EQ(read_ftm("Peer 0A:0B:0C:0D:0E:0F: @1\nFTM\nDIST_AVG: 1\n").ranges.at(0).bssid,
            "0a:0b:0c:0d:0e:0f");
}

TEST(IwFtm, ABadResultIsLeftOutCountedAndNamed) {
  const IwFtmLog log =
      read_ftm(kHead + "  Peer 02:00:00:00:01: status=0\n" + kGood + "      RTT_AVG: 26685\n");
  EXPECT_EQ(log.ranges.size(), 1U);
  ASSERT_EQ(log.warnings.size(), 1U);
  EXPECT_NE(log.warnings[0].find("1 result is left out; the first: "), std::string::npos);
}

TEST(IwFtm, RefusesWhatIsNoResult) {
  expect_refusal([] { read_ftm("Scanning\nBSS 02:00:00:00:01:00\n"); }, 0, "contains no result of iw's");
  expect_refusal([] { read_ftm(kHead + "  Peer 02:00:00:00:01: status=0\n"); }, 2, "not a valid address");
  expect_refusal([] { read_ftm(kHead + "  Peer no MAC address\n"); }, 2, "not followed by a colon");
  expect_refusal([] { read_ftm("  Peer 02:00:00:00:01:00: @soon\n"); }, 1, "not a time in nanoseconds");
  expect_refusal([] { answer("      RTT_AVG: 12.5\n"); }, 4, "RTT_AVG is not a whole number");
  expect_refusal([] { answer("      RTT_AVG: 1\n      RTT_AVG: 2\n"); }, 5, "appears twice");
  expect_refusal([] { answer("      DIST_AVG: 1\n      DIST_VARIANCE: -1\n"); }, 5, "is negative");
}

}  // namespace
}  // namespace radioslam
