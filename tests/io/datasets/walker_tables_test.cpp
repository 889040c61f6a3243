// Tables of phones' sensors in other programs' columns and units, and waypoints.
#include "radioslam/io/datasets/walker_tables.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "io/refusal.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {
namespace {

constexpr double kGravity = 9.80665;

/// Ten samples at 100 Hz; a row is `row(time in s, up)`.
std::string table(const std::string& head, const std::function<std::string(double, double)>& row) {
  std::string content = head + "\n";
  for (int k = 0; k < 10; ++k) content += row(0.01 * k, kGravity) + "\n";
  return content;
}

PhoneMotion read_imu_table(const std::string& content, std::vector<std::string>* warnings = nullptr) {
  std::vector<std::string> unused;
  return read_walker_imu({make_tool_output("phone.csv", content)}, warnings == nullptr ? unused : *warnings);
}

std::string text_of(double value) { return format_number(value); }

TEST(WalkerImu, RecognisesTheColumnsOfManyPrograms) {
  for (const char* head :
       {"t_s,ax_mps2,ay_mps2,az_mps2,wx_radps,wy_radps,wz_radps",
        "time,acc_x,acc_y,acc_z,gyro_x,gyro_y,gyro_z",
        "%time,field.linear_acceleration.x,field.linear_acceleration.y,field.linear_acceleration.z,"
        "field.angular_velocity.x,field.angular_velocity.y,field.angular_velocity.z",
        "Time (s),Acceleration x (m/s^2),Acceleration y (m/s^2),Acceleration z (m/s^2),Gyroscope x (rad/s),"
        "Gyroscope y (rad/s),Gyroscope z (rad/s)",
        "timestamp,accelerometerX,accelerometerY,accelerometerZ,rotationRateX,rotationRateY,rotationRateZ",
        "timestamp,ax,ay,az,gx,gy,gz"}) {
    const PhoneMotion motion = read_imu_table(
        table(head, [](double t, double up) { return text_of(t) + ",0,0," + text_of(up) + ",0.1,0.2,0.3"; }));
    ASSERT_EQ(motion.specific_force_mps2.size(), 10U) << head;
    EXPECT_EQ(motion.specific_force_mps2[3].value, Eigen::Vector3d(0, 0, kGravity)) << head;
    EXPECT_EQ(motion.angular_rate_radps[3].value, Eigen::Vector3d(0.1, 0.2, 0.3)) << head;
    EXPECT_EQ(motion.angular_rate_radps[3].stamp.ns, 30'000'000) << head;
  }
}

TEST(WalkerImu, FindsUnitsAndSaysSo) {
  std::vector<std::string> warnings;
  const PhoneMotion motion = read_imu_table(table("time;ax;ay;az;gyro_x_dps;gyro_y_dps;gyro_z_dps",
                                                  [](double t, double) {
                                                    return "15744071230" +
                                                           std::to_string(std::lround(100 * t)) +
                                                           "0000000;0,0;0,0;1,0;180,0;0,0;0,0";
                                                  }),
                                            &warnings);
  EXPECT_NEAR(motion.specific_force_mps2[0].value.z(), kGravity, 1e-12);
  EXPECT_NEAR(motion.angular_rate_radps[0].value.x(), 3.14159265358979, 1e-12);
  ASSERT_EQ(warnings.size(), 3U);
  EXPECT_NE(warnings[0].find("its times are read as nanoseconds"), std::string::npos);
  EXPECT_NE(warnings[1].find("its accelerations are read as g"), std::string::npos);
  EXPECT_NE(warnings[2].find("its rates are read as degrees per second"), std::string::npos);
}

TEST(WalkerImu, JoinsATablePerSensorAndTurnsTheDeviceUpright) {
  const std::string force =
      table("seconds,z,y,x", [](double t, double up) { return text_of(t) + ",0," + text_of(up) + ",0"; });
  const std::string rate = table("seconds,z,y,x", [](double t, double) { return text_of(t) + ",0,0.5,0"; });
  std::vector<std::string> warnings;
  const PhoneMotion motion = read_walker_imu(
      {make_tool_output("Accelerometer.csv", force), make_tool_output("Gyroscope.csv", rate)}, warnings);
  EXPECT_LT((motion.specific_force_mps2[0].value - Eigen::Vector3d(0, 0, kGravity)).norm(), 1e-9);
  EXPECT_LT((motion.angular_rate_radps[0].value - Eigen::Vector3d(0, 0, 0.5)).norm(), 1e-9);
}

TEST(WalkerImu, LeavesOutBadRowsAndSortsLateOnes) {
  std::vector<std::string> warnings;
  std::string content = table("t,ax,ay,az,wx,wy,wz", [](double t, double up) {
    return text_of(t) + ",0,0," + text_of(up) + ",0,0,0";
  });
  content += "0.1,0,0,\x01,0,0,0\n0.055,0,0,9.8,0,0,0\n";
  const PhoneMotion motion = read_imu_table(content, &warnings);
  EXPECT_EQ(motion.specific_force_mps2.size(), 11U);
  EXPECT_EQ(motion.specific_force_mps2[6].stamp.ns, 55'000'000);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("phone.csv: 1 row is left out; the first: phone.csv:12:"), std::string::npos);
}

TEST(WalkerImu, RefusesWhatIsNoWalkersRecording) {
  const auto rows = [](const std::string& head, const std::string& values) {
    return table(head, [&](double t, double) { return text_of(t) + values; });
  };
  expect_refusal([&] { read_imu_table(rows("a,ax,ay,az", ",0,0,9.8")); }, 1, "has no column of time");
  expect_refusal([&] { read_imu_table(rows("t,u,v,w", ",0,0,9.8")); }, 1, "neither x y z");
  expect_refusal([&] { read_imu_table(rows("t,ax,ay,az", ",0,0,9.8")); }, 1, "no columns of a gyroscope");
  expect_refusal([&] { read_imu_table(rows("t,wx,wy,wz", ",0,0,0")); }, 1, "no columns of an accelerometer");
  expect_refusal([&] { read_imu_table(rows("t,ax,ay,az,wx,wy,wz", ",0,0,0.2,0,0,0")); }, 0,
                 "gravity in no unit");
  expect_refusal([] { read_imu_table("t,ax,ay,az,wx,wy,wz\n0,0,0,9.8,0,0,0\n"); }, 1,
                 "fewer than two samples");
  expect_refusal([] { read_imu_table("t,ax,ay,az,wx,wy,wz\n0,0,0,9.8,0,0,0\n0,0,0,9.8,0,0,0\n"); }, 0,
                 "its times are not those of samples");
  std::vector<std::string> warnings;
  const Text force = make_tool_output("acc.csv", rows("t,x,y,z", ",0,0,9.8"));
  expect_refusal([&] { read_walker_imu({force, force}, warnings); }, 1, "second table of the accelerometer");
}

TEST(Waypoints, AreJoinedByStraightLinesThatTheWalkerFaces) {
  std::vector<std::string> warnings;
  const Trajectory<SE3> path =
      read_waypoints(make_tool_output("plan.csv", "t_s,x_m,y_m\n10,1,1\n12,3,1\n14,3,1\n15,3,4\n"), warnings);
  ASSERT_EQ(path.size(), 6U);
  EXPECT_EQ(path[1].pose.translation(), Eigen::Vector3d(2, 1, 0));
  EXPECT_EQ(path[2].pose.yaw(), 0) << "standing, it faces where it went";
  EXPECT_NEAR(path[4].pose.yaw(), 1.5707963267948966, 1e-12);
  EXPECT_EQ(path.back().pose.translation(), Eigen::Vector3d(3, 4, 0));
  EXPECT_EQ(path.back().stamp.ns, 15'000'000'000);
}

TEST(Waypoints, RefusesTablesOfSomethingElse) {
  std::vector<std::string> warnings;
  const auto read = [&](const std::string& content) {
    read_waypoints(make_tool_output("plan.csv", content), warnings);
  };
  expect_refusal([&] { read("t_s,x\n0,0\n"); }, 1, "needs the columns t_s, x and y");
  expect_refusal([&] { read("t_s,x,y\n0,0,0\n"); }, 0, "fewer than two waypoints");
  expect_refusal([&] { read("t_s,x,y\n0,here,0\n"); }, 2, "x 'here'");
}

}  // namespace
}  // namespace radioslam
