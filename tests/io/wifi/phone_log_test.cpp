#include "radioslam/io/wifi/phone_log.hpp"

#include <gtest/gtest.h>

#include "io/refusal.hpp"
#include "io/wifi/phone_log_text.hpp"

namespace radioslam {
namespace {

constexpr std::int64_t kMs = 1'000'000;

PhoneLog read_phone(const std::vector<std::string>& lines) {
  return read_phone_log(make_text("walk.txt", joined(lines)));
}

/// Expects that of the log with line `number` replaced, that record alone is left out, and named.
void expect_line_left_out(std::size_t number, const std::string& line, const std::string& words) {
  auto lines = phone_log_lines();
  lines[number - 1] = line;
  const PhoneLog log = read_phone(lines);
  ASSERT_FALSE(log.warnings.empty()) << line;
  const std::string expected =
      "walk.txt: 1 record is left out; the first: walk.txt:" + std::to_string(number) + ": ";
  EXPECT_EQ(log.warnings.back().substr(0, expected.size()), expected);
  EXPECT_NE(log.warnings.back().find(words), std::string::npos) << log.warnings.back();
}

std::vector<std::string> without(const std::string& type) {
  std::vector<std::string> kept;
  for (const auto& line : phone_log_lines())
    if (line.find(type) == std::string::npos) kept.push_back(line);
  return kept;
}

TEST(ReadPhoneLog, ReadsEveryRecord) {
  const PhoneLog log = read_phone(phone_log_lines());
  EXPECT_EQ(log.start.ns, 1574242584992 * kMs);
  EXPECT_EQ(log.begin, log.start);
  EXPECT_EQ(log.end.ns, 1574242586500 * kMs);
  EXPECT_TRUE(log.complete);
  ASSERT_EQ(log.motion.specific_force_mps2.size(), 2U);
  EXPECT_EQ(log.motion.specific_force_mps2[1].value, Eigen::Vector3d(0.5, -0.25, 9.5));
  ASSERT_EQ(log.motion.angular_rate_radps.size(), 2U);
  EXPECT_EQ(log.motion.angular_rate_radps[0].stamp.ns, 1574242585000 * kMs);
  EXPECT_EQ(log.motion.angular_rate_radps[0].value, Eigen::Vector3d(0.25, 0.375, 0.125));
  ASSERT_EQ(log.waypoints.size(), 2U);
  EXPECT_EQ(log.waypoints[0].position_m, Eigen::Vector2d(204.25, 287.5));
}

TEST(ReadPhoneLog, TheRotationVectorsScalarPartComesFromItsLength) {
  const PhoneLog log = read_phone(phone_log_lines());
  ASSERT_EQ(log.motion.orientation.size(), 1U);
  EXPECT_TRUE(log.motion.orientation[0].R_enu_device.isApprox(Eigen::Quaterniond(0.8, 0, 0, -0.6), 1e-12));
}

TEST(ReadPhoneLog, ReadsScansEvenWithTabsInANetworksName) {
  const PhoneLog log = read_phone(phone_log_lines());
  ASSERT_EQ(log.wifi.size(), 3U);
  EXPECT_EQ(log.wifi[0].bssid, "0e:74:9c:a7:b2:e4");
  EXPECT_EQ(log.wifi[0].rssi_dbm, -43);
  EXPECT_EQ(log.wifi[0].frequency_mhz, 5805);
  EXPECT_EQ(log.wifi[0].last_seen.ns, 1574242585900 * kMs);
  EXPECT_EQ(log.wifi[1].bssid, "0a:74:9c:a7:b2:e4");
  EXPECT_EQ(log.wifi[2].bssid, "02:00:00:00:00:01");
}

TEST(ReadPhoneLog, TakesTimesInOtherUnits) {
  for (const char* time : {"1574242585020", "1574242585020000", "1574242585020000000", "1574242585.020"}) {
    auto lines = phone_log_lines();
    lines[7] = time + std::string("\tTYPE_ACCELEROMETER\t0.5\t-0.25\t9.5\t2");
    const PhoneLog log = read_phone(lines);
    EXPECT_EQ(log.motion.specific_force_mps2.at(1).stamp.ns, 1574242585020 * kMs) << time;
    EXPECT_TRUE(log.warnings.empty()) << time;
  }
}

TEST(ReadPhoneLog, WithoutAHeaderTheFirstRecordIsTheStart) {
  auto lines = phone_log_lines();
  lines.front() = "";
  lines.pop_back();
  const PhoneLog log = read_phone(lines);
  EXPECT_EQ(log.start.ns, 1574242584999 * kMs);
  EXPECT_FALSE(log.complete);
}

TEST(ReadPhoneLog, TakesLineEndsOfWindows) {
  std::string text = joined(phone_log_lines());
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.insert(at, "\r");
  EXPECT_EQ(read_phone_log(make_text("walk.txt", text)).waypoints.size(), 2U);
}

TEST(ReadPhoneLog, LeavesOutLinesGluedTogether) {
  const auto lines = phone_log_lines();
  expect_line_left_out(8, lines[7] + lines[8], "without a line break between them");
  expect_line_left_out(5, lines[4] + lines[7], "without a line break between them");
}

TEST(ReadPhoneLog, LeavesOutTruncatedLines) {
  expect_line_left_out(8, "1574242585020\tTYPE_ACCELEROMETER\t0.5\t-0.25", "4 fields instead of 6");
  expect_line_left_out(8, "1574242585020\tTYPE_ACCELEROMETER\t0.5\t-0.25\t9.5", "5 fields instead of 6");
  expect_line_left_out(13, "1574242586500\tTYPE_WAYPOINT\t205.5", "3 fields instead of 4");
  expect_line_left_out(10, "1574242586000\tTYPE_WIFI\tcafe\t0e:74:9c:a7:b2:e4\t-43\t5805",
                       "6 fields instead of 7");
  expect_line_left_out(8, "1574242585020", "not a record type");
  expect_line_left_out(8, "1574242585020\tTY", "not a record type");
}

TEST(ReadPhoneLog, LeavesOutWhatIsNoNumber) {
  expect_line_left_out(4, "1574242585000\tTYPE_ACCELEROMETER\t0.5\tnan\t9.75\t2", "y 'nan'");
  expect_line_left_out(3, "1574242584999\tTYPE_WAYPOINT\t1e9\t287.5", "plausible coordinate");
  expect_line_left_out(4, "15742425850x0\tTYPE_ACCELEROMETER\t0.5\t0\t9.75\t2", "whole milliseconds");
  expect_line_left_out(4, "99999999999999999\tTYPE_ACCELEROMETER\t0.5\t0\t9.75\t2", "whole milliseconds");
  expect_line_left_out(1, "#\tstartTime:soon", "start time");
  expect_line_left_out(10, "1574242586000\tTYPE_WIFI\tcafe\t0e:74:9c:a7:b2:e4\t-430\t5805\t1574242585900",
                       "signal strength");
  expect_line_left_out(10, "1574242586000\tTYPE_WIFI\tcafe\t\t-43\t5805\t1574242585900", "BSSID");
}

TEST(ReadPhoneLog, LeavesOutARotationVectorLongerThanOne) {
  expect_line_left_out(7, "1574242585000\tTYPE_ROTATION_VECTOR\t0.8\t0.0\t-0.7\t3", "longer than 1");
}

TEST(ReadPhoneLog, SortsRecordsThatAreLateByLessThanASecond) {
  auto lines = phone_log_lines();
  lines[7] = "1574242584950\tTYPE_ACCELEROMETER\t0.5\t-0.25\t9.5\t2";
  const PhoneLog log = read_phone(lines);
  ASSERT_EQ(log.motion.specific_force_mps2.size(), 2U);
  EXPECT_EQ(log.motion.specific_force_mps2[0].stamp.ns, 1574242584950 * kMs);
  EXPECT_EQ(log.motion.specific_force_mps2[0].value, Eigen::Vector3d(0.5, -0.25, 9.5));
  ASSERT_EQ(log.warnings.size(), 1U);
  EXPECT_EQ(log.warnings[0], "walk.txt: 1 records are earlier than the one before them and were sorted");
}

TEST(ReadPhoneLog, LeavesOutARecordOfAnotherTime) {
  auto lines = phone_log_lines();
  lines.insert(lines.end() - 1, {"1574242585040\tTYPE_ACCELEROMETER\t0.5\t-0.25\t9.5\t2",
                                 "1574242085060\tTYPE_ACCELEROMETER\t0.5\t-0.25\t9.5\t2"});
  const PhoneLog log = read_phone(lines);
  EXPECT_EQ(log.motion.specific_force_mps2.size(), 3U);
  EXPECT_EQ(log.begin.ns, 1574242584992 * kMs);
  ASSERT_EQ(log.warnings.size(), 1U);
  EXPECT_NE(log.warnings[0].find("runs backwards by more than a second"), std::string::npos);
}

TEST(ReadPhoneLog, AControlCharacterInANetworksNameCostsNothing) {
  auto lines = phone_log_lines();
  lines[9] =
      "1574242586000\tTYPE_WIFI\tca\x01\xff"
      "fe\t0e:74:9c:a7:b2:e4\t-43\t5805\t1574242585900";
  const PhoneLog log = read_phone_log(make_tool_output("walk.txt", joined(lines)));
  EXPECT_EQ(log.wifi.size(), 3U);
  ASSERT_EQ(log.warnings.size(), 1U);
  EXPECT_EQ(log.warnings[0],
            "walk.txt:10: has control characters, as names of networks may have; names are not imported");
}

TEST(ReadPhoneLog, RefusesALogOfWhichMostRecordsAreMalformed) {
  auto lines = phone_log_lines();
  for (int k = 0; k < 30; ++k) lines.insert(lines.begin(), "15742425850x\tTYPE_GYROSCOPE\t1\t2\t3\t3");
  expect_refusal([&] { read_phone(lines); }, 1, "whole milliseconds");
}

TEST(ReadPhoneLog, RefusesALogThatIsNoWalk) {
  expect_refusal([] { read_phone(without("ACCELEROMETER")); }, 0, "TYPE_ACCELEROMETER");
  expect_refusal([] { read_phone(without("GYROSCOPE")); }, 0, "TYPE_GYROSCOPE");
  expect_refusal([] { read_phone(without("TYPE")); }, 0, "no records");
  expect_refusal(
      [] {
        read_phone({"1574242585000\tTYPE_ACCELEROMETER\t0.5\t-0.25\t9.75\t2",
                    "1574242585000\tTYPE_GYROSCOPE\t0.25\t0.375\t0.125\t3"});
      },
      0, "the same time");
}

}  // namespace
}  // namespace radioslam
