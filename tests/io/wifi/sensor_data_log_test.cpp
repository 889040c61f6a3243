#include "radioslam/io/wifi/sensor_data_log.hpp"

#include <gtest/gtest.h>

#include "io/refusal.hpp"

namespace radioslam {
namespace {

PhoneLog read(const std::string& content) {
  const Text text = make_tool_output("logfile.txt", content);
  EXPECT_TRUE(is_sensor_data_log(text));
  return read_sensor_data_log(text);
}

const std::string kHead = "\n% LogFile created by the 'GetSensorData' App for Android.\n%\n";

TEST(SensorDataLog, ReadsMotionAndScans) {
  const PhoneLog log = read(
      kHead +
      "ACCE;0.031;8902.510;0.1;0.2;9.8;3\nGYRO;0.033;8902.512;0.01;0.02;0.03;3\n"
      "AHRS;0.034;8902.513;1;2;3;0;0;0.6;3\nMAGN;0.034;8902.513;1;2;3;3\n"
      "ACCE;0.051;8902.530;0.1;0.2;9.7;3\n"
      "WIFI;1.5;8903.9;eduroam;02:AA:00:00:01:00;2412;-61;\nWIFI;1.5;8903.9;a;b;02:aa:00:00:02:00;-70\n");
  ASSERT_EQ(log.motion.specific_force_mps2.size(), 2U);
  EXPECT_EQ(log.motion.specific_force_mps2[0].value, Eigen::Vector3d(0.1, 0.2, 9.8));
  ASSERT_EQ(log.motion.orientation.size(), 1U);
  EXPECT_NEAR(log.motion.orientation[0].R_enu_device.w(), 0.8, 1e-9);
  ASSERT_EQ(log.wifi.size(), 2U);
  EXPECT_EQ(log.wifi[0].bssid, "02:aa:00:00:01:00");
  EXPECT_EQ(log.wifi[0].frequency_mhz, 2412);
  EXPECT_EQ(log.wifi[0].rssi_dbm, -61);
  EXPECT_EQ(log.wifi[1].bssid, "02:aa:00:00:02:00") << "names may contain semicolons";
  EXPECT_EQ(log.wifi[1].frequency_mhz, 0);
  EXPECT_EQ(log.wifi[1].scan, Stamp{1'500'000'000});
}

/// The app received three samples at once; the sensor measured them evenly.
TEST(SensorDataLog, SamplesHaveTheSensorsTimesOnTheAppsClock) {
  const PhoneLog log = read(kHead +
                            "ACCE;10.06;500.00;0;0;9.8;3\nACCE;10.06;500.02;0;0;9.8;3\n"
                            "ACCE;10.06;500.04;0;0;9.8;3\nGYRO;10.0;0;0;0;0;3\nGYRO;10.1;0;0;0;0;3\n");
  const auto& force = log.motion.specific_force_mps2;
  EXPECT_EQ(force[0].stamp, Stamp{10'040'000'000});
  EXPECT_EQ(force[2].stamp, Stamp{10'080'000'000});
  EXPECT_EQ(log.motion.angular_rate_radps[1].stamp, Stamp{10'100'000'000}) << "a sensor's clock that stands";
}

TEST(SensorDataLog, LeavesOutBadRecordsAndRefusesOtherFiles) {
  const PhoneLog log = read(kHead +
                            "ACCE;1;1;0;0;9.8;3\nACCE;1.1;1.1;0;0\nWIFI;1.2;1.2;name;nowhere;-50\n"
                            "ACCE;1.2;1.2;0;0;9.8;3\nGYRO;1.2;1.2;0;0;0;3\n");
  EXPECT_EQ(log.motion.specific_force_mps2.size(), 2U);
  ASSERT_FALSE(log.warnings.empty());
  EXPECT_NE(log.warnings[0].find("2 records are left out; the first: logfile.txt:5: ACCE has 5 fields"),
            std::string::npos)
      << log.warnings[0];
  EXPECT_FALSE(is_sensor_data_log(make_tool_output("x", "t;x;y\n1;2;3\n")));
  const Text empty = make_tool_output("x", "MAGN;1;1;0;0;9.8;3\n");
  expect_refusal([&] { read_sensor_data_log(empty); }, 0, "no records of motion or WiFi");
}

}  // namespace
}  // namespace radioslam
