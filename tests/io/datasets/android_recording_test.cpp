#include "radioslam/io/datasets/android_recording.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "io/refusal.hpp"
#include "io/temporary_folder.hpp"
#include "io/wifi/phone_log_text.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {
namespace {

constexpr double kGravity = 9.80665;
constexpr double kStart_s = 1574407100;

/// Twelve seconds at 50 Hz from kStart_s, in nanoseconds as Sensor Logger writes them.
std::string samples(const std::function<std::string(double t)>& zyx) {
  std::string table = "time,seconds_elapsed,z,y,x\n";
  for (int k = 0; k <= 600; ++k) {
    const double t = 0.02 * k;
    table += format_stamp(Stamp::from_seconds(kStart_s + t)).substr(0, 10) +
             std::to_string(1'000'000'000 + 20'000'000LL * (k % 50)).substr(1);
    table += "," + format_number(t) + "," + zyx(t) + "\n";
  }
  return table;
}

/// Two steps a second, the phone flat.
double step(double t) { return -2.5 * std::cos(4 * 3.14159265 * t); }

const std::string kScans =
    "time,seconds_elapsed,ssid,bssid,frequency,level,capabilities\n"
    "1574407103000000000,3,net,02:aa:00:00:01:00,2412,-53,[]\n"
    "1574407106000000000,6,net,02:aa:00:00:02:00,5180,-63,[]\n";

struct SensorLogger : testing::Test {
  void SetUp() override {
    const auto still = [](double) { return std::string("0,0,0"); };
    folder.write("walk/Gyroscope.csv", samples(still));
    folder.write("walk/GyroscopeUncalibrated.csv", samples(still));
    folder.write("walk/Location.csv", "time,seconds_elapsed,latitude,longitude\n1,2,3,4\n");
    folder.write("walk/WiFi.csv", kScans);
  }
  AndroidRecording read(const AndroidParams& params = {}) const {
    return read_android_recording({folder.path() / "walk"}, params);
  }
  TemporaryFolder folder;
};

TEST_F(SensorLogger, BecomesScansAndAWalk) {
  folder.write("walk/TotalAcceleration.csv",
               samples([](double t) { return format_number(kGravity + step(t)) + ",0,0"; }));
  folder.write("walk/Accelerometer.csv", samples([](double t) { return format_number(step(t)) + ",0,0"; }));
  const AndroidRecording recording = read();
  EXPECT_EQ(recording.wifi.rows.size(), 2U);
  EXPECT_GT(recording.steps, 15U);
  EXPECT_GT(recording.robot.odometry.back().pose.translation().norm(), 5);
  EXPECT_EQ(recording.robot.heading, Heading::kRelative);
  ASSERT_FALSE(recording.warnings.empty());
  EXPECT_EQ(recording.warnings.back(), "files that are not used: Location.csv");
}

/// Apps that divide the accelerometer's readings into motion and gravity lose nothing.
TEST_F(SensorLogger, GravityOfATableOfItsOwnIsAdded) {
  folder.write("walk/TotalAcceleration.csv",
               samples([](double t) { return format_number(kGravity + step(t)) + ",0,0"; }));
  const AndroidRecording total = read();
  std::filesystem::remove(folder.path() / "walk/TotalAcceleration.csv");
  folder.write("walk/Accelerometer.csv", samples([](double t) { return format_number(step(t)) + ",0,0"; }));
  EXPECT_NE(refusal([&] { read(); }).find("gravity in no unit"), std::string::npos);
  folder.write("walk/Gravity.csv", samples([](double) { return format_number(kGravity) + ",0,0"; }));
  const AndroidRecording sum = read();
  EXPECT_EQ(sum.steps, total.steps);
  EXPECT_TRUE(sum.robot.odometry.back().pose.translation().isApprox(
      total.robot.odometry.back().pose.translation(), 1e-6));
}

TEST_F(SensorLogger, ScansOnAnotherClockAreRefusedOrMoved) {
  folder.write("walk/TotalAcceleration.csv",
               samples([](double t) { return format_number(kGravity + step(t)) + ",0,0"; }));
  folder.write("walk/WiFi.csv", "time,bssid,level\n3,02:aa:00:00:01:00,-53\n");
  EXPECT_NE(refusal([&] { read(); }).find("none of the WiFi scans, the first at 3 s, is within the time of"),
            std::string::npos);
  AndroidParams moved;
  moved.scans.clock_offset_s = kStart_s;
  EXPECT_EQ(read(moved).wifi.rows.front().stamp, Stamp::from_seconds(kStart_s + 3));
}

TEST(AndroidRecording, ReadsATableOfBothSensors) {
  const TemporaryFolder folder;
  std::string table = "time,gFx,gFy,gFz,wx,wy,wz,Bx,By,Bz\n";
  for (int k = 0; k <= 600; ++k)
    table +=
        format_number(0.02 * k) + ",0,0," + format_number(1 + step(0.02 * k) / kGravity) + ",0,0,0,1,2,3\n";
  const auto recording = read_android_recording({folder.write("physics.csv", table)}, {});
  EXPECT_GT(recording.steps, 15U);
  EXPECT_TRUE(recording.wifi.rows.empty());
}

TEST(AndroidRecording, ReadsLogsWithWaypoints) {
  const TemporaryFolder folder;
  const auto recording = read_android_recording({folder.write("walk.txt", joined(phone_log_lines()))}, {});
  EXPECT_EQ(recording.truth.size(), 2U);
  EXPECT_EQ(recording.robot.heading, Heading::kAbsolute);
  EXPECT_EQ(recording.wifi.rows.size(), 2U);
  EXPECT_EQ(recording.wifi.counts.begin()->first, "readings are from before the recording and left out");
}

TEST(AndroidRecording, RefusesWhatItCannotRead) {
  const TemporaryFolder folder;
  const auto other = folder.write("other.csv", "a,b\n1,2\n");
  const auto log = folder.write("walk.txt", joined(phone_log_lines()));
  EXPECT_NE(refusal([&] { read_android_recording({other}, {}); }).find("is neither a table of WiFi scans"),
            std::string::npos);
  EXPECT_NE(refusal([&] {
              read_android_recording({log, log}, {});
            }).find("is a second log"),
            std::string::npos);
  folder.write("empty/readme.txt", "nothing\n");
  EXPECT_NE(refusal([&] { read_android_recording({folder.path() / "empty"}, {}); }).find("has neither"),
            std::string::npos);
}

}  // namespace
}  // namespace radioslam
