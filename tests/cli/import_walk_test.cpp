// radioslam import imu, waypoints: a walker's odometry, in a mission that is there or in a new one.
#include <gtest/gtest.h>

#include <cmath>

#include "cli/import_fixture.hpp"

namespace radioslam::cli {
namespace {

/// Twelve seconds of walking straight on, at 50 Hz: two steps a second, the device flat.
std::string walk() {
  std::string table = "time_s,acc_x,acc_y,acc_z,gyro_x,gyro_y,gyro_z\n";
  for (int k = 0; k <= 600; ++k) {
    const double t = 0.02 * k, up = 9.80665 - 2.5 * std::cos(4 * 3.14159265 * t);
    table += std::to_string(t) + ",0,0," + std::to_string(up) + ",0,0,0\n";
  }
  return table;
}

struct ImportWalk : ImportFixture {
  void SetUp() override {
    write_file(folder.path() / "walk.csv", walk());
    write_file(folder.path() / "plan.csv", "t_s,x,y\n0,1,1\n4,5,1\n8,5,4\n");
    write_file(folder.path() / "scan.txt",
               "100\nBSS 02:00:00:00:01:00(on wlan0)\n\tfreq: 2412\n\tsignal: -53.00 dBm\n");
  }
  std::string file(const std::string& name) const { return read_file(folder.path() / name); }
};

TEST_F(ImportWalk, GivesALaptopsScansTheOdometryThatTheyLack) {
  ASSERT_EQ(import({"iw", "scan.txt", "--robot", "laptop", "-o", "m"}).status, 0);
  const Outcome outcome = import({"imu", "walk.csv", "--robot", "laptop", "-o", "m"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find(" steps, "), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("is missing"), std::string::npos) << outcome.out;
  EXPECT_EQ(
      files_in(folder.path() / "m"),
      (std::vector<std::string>{"mission.yaml", "robots/laptop/odometry.tum", "robots/laptop/wifi.csv"}));
  EXPECT_NE(file("m/mission.yaml").find("sigma_xy_per_sqrt_m: 0.2"), std::string::npos)
      << file("m/mission.yaml");
  expect_refused({"imu", "walk.csv", "--robot", "laptop", "-o", "m"}, "robot 'laptop' has odometry.tum");
  expect_refused({"waypoints", "plan.csv", "--robot", "laptop", "-o", "m"},
                 "robot 'laptop' has odometry.tum");
  EXPECT_EQ(import({"waypoints", "plan.csv", "--robot", "laptop", "--replace", "-o", "m"}).status, 0);
}

TEST_F(ImportWalk, WaypointsBecomeOdometryFromTheFirst) {
  const Outcome outcome = import({"waypoints", "plan.csv", "--robot", "a", "-o", "m"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("initial_pose: [1, 1, 0, 0]"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("m: 7 m of odometry of a"), std::string::npos) << outcome.out;
  const std::string tum = file("m/robots/a/odometry.tum");
  EXPECT_TRUE(tum.starts_with("0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n")) << tum;
  EXPECT_NE(tum.find("\n8 4 3 0 "), std::string::npos) << tum;
}

TEST_F(ImportWalk, RefusesTablesOfSomethingElse) {
  write_file(folder.path() / "other.csv", "t_s,x,y\n0,1,1\n");
  expect_refused({"waypoints", "other.csv", "--robot", "a", "-o", "m"}, "fewer than two waypoints");
  expect_refused({"imu", "plan.csv", "--robot", "a", "-o", "m"}, "neither x y z of an accelerometer nor");
}

}  // namespace
}  // namespace radioslam::cli
