#include "radioslam/io/lidar/carmen.hpp"

#include <cmath>
#include <numbers>
#include <set>

#include "io/recorded_data.hpp"
#include "io/refusal.hpp"
#include "radioslam/io/text/compressed_text.hpp"
#include "radioslam/io/text/line_fields.hpp"

namespace radioslam {
namespace {

ImportedMission read_carmen(const std::string& log, const CarmenParams& params = {}) {
  return read_carmen(make_text("log.clf", log), "a", params);
}

/// A FLASER line with three readings (-90, 0 and 90 degrees).
std::string flaser(const std::string& readings, const std::string& odometry, const std::string& time) {
  return "FLASER 3 " + readings + " 9 9 9 " + odometry + " " + time + " nohost 0.1\n";
}

TEST(Carmen, TurnsReadingsIntoPointsOfTheBody) {
  const auto imported = read_carmen(
      "# a comment\nPARAM robot_frontlaser_offset 0.5 nohost 0\nPARAM robot_rearlaser_offset 7 nohost 0\n"
      "SYNC start 0 nohost 0\n" +
      flaser("1 2 3", "0 0 0", "10.5") + flaser("9 -1 0", "0 0 0", "11"));
  const Robot& robot = imported.mission.robots[0];
  EXPECT_EQ(imported.mission.dimension, 2);
  EXPECT_EQ(robot.id, "a");
  EXPECT_NEAR(robot.lidar_view_rad, 1.5 * std::numbers::pi, 1e-12) << "three readings of 90 degrees each";
  ASSERT_EQ(robot.lidar.size(), 2U);
  EXPECT_EQ(robot.lidar.stamps[0], Stamp{10'500'000'000});
  const LidarScan scan = robot.lidar.read(0);
  ASSERT_EQ(scan.points.size(), 3U);
  EXPECT_LT((scan.points[0] - Eigen::Vector3f(0.5F, -1, 0)).norm(), 1e-6);
  EXPECT_LT((scan.points[1] - Eigen::Vector3f(2.5F, 0, 0)).norm(), 1e-6);
  EXPECT_LT((scan.points[2] - Eigen::Vector3f(0.5F, 3, 0)).norm(), 1e-6);
  EXPECT_TRUE(scan.times_s.empty());
  EXPECT_TRUE(robot.lidar.read(1).points.empty()) << "the largest reading, a negative one and zero";
}

/// The direction of the last of n readings.
double last_angle_deg(std::size_t n) {
  std::string line = "FLASER " + std::to_string(n);
  for (std::size_t k = 0; k < n; ++k) line += k + 1 < n ? " 0" : " 5";
  const auto imported = read_carmen(line + " 0 0 0 0 0 0 1 h 0\n" + flaser("9 9 9", "0 0 0", "2"));
  const Eigen::Vector3f point = imported.mission.robots[0].lidar.read(0).points.at(0);
  return static_cast<double>(std::atan2(point.y(), point.x())) * 180 / std::numbers::pi;
}

TEST(Carmen, SpreadsReadingsOverHalfACircle) {
  EXPECT_NEAR(last_angle_deg(181), 90, 1e-5);
  EXPECT_NEAR(last_angle_deg(180), 89, 1e-5);
  EXPECT_NEAR(last_angle_deg(361), 90, 1e-5);
  EXPECT_NEAR(last_angle_deg(360), 89.5, 1e-5);
}

TEST(Carmen, OdometryIsTheScansAndBeginsAtTheStart) {
  const auto imported =
      read_carmen("ODOM 5 5 5 0 0 0 9 nohost 0\n" + flaser("1 2 3", "10 20 1.5707963267948966", "10") +
                  flaser("1 2 3", "10 22 1.5707963267948966", "11"));
  const auto& odometry = imported.mission.robots[0].odometry;
  ASSERT_EQ(odometry.size(), 2U);
  EXPECT_EQ(odometry[0].stamp, Stamp{10'000'000'000});
  EXPECT_LT(odometry[0].pose.log().norm(), 1e-12);
  EXPECT_LT((odometry[1].pose.translation() - Eigen::Vector3d(2, 0, 0)).norm(), 1e-12);
  EXPECT_EQ(imported.mission.robots[0].odometry_noise.sigma_yaw_per_rad, CarmenParams{}.sigma_yaw_per_rad);
}

TEST(Carmen, PutsALateLineBeforeThoseThatFollow) {
  const auto imported = read_carmen(flaser("1 2 3", "0 0 0", "10") + flaser("1 2 3", "1 0 0", "12") +
                                    flaser("1 2 3", "2 0 0", "11") + flaser("1 2 3", "3 0 0", "13"));
  const Robot& robot = imported.mission.robots[0];
  EXPECT_EQ(robot.lidar.stamps,
            (std::vector<Stamp>{{10'000'000'000}, {10'999'999'000}, {11'000'000'000}, {13'000'000'000}}));
  EXPECT_EQ(robot.odometry[1].pose.translation().x(), 1) << "the log's order is kept";
  ASSERT_EQ(imported.warnings.size(), 1U);
  EXPECT_NE(imported.warnings[0].find("1 scans are stamped later"), std::string::npos);
}

TEST(Carmen, ReadsScansThatDescribeThemselves) {
  const auto imported = read_carmen(
      "ROBOTLASER1 0 -0.5 1 0.5 10 0.01 0 3 2 2 10 3 7 8 9 1 2 1.5707963267948966 1 1 1.5707963267948966 0 0 "
      "0.3 "
      "0.2 0 100.5 host 3\n");
  const Robot& robot = imported.mission.robots[0];
  EXPECT_EQ(robot.lidar.stamps[0], Stamp{100'500'000'000});
  const LidarScan scan = robot.lidar.read(0);
  ASSERT_EQ(scan.points.size(), 2U) << "the third is at the scanner's limit";
  const Eigen::Vector3d first(1 + 2 * std::cos(0.5), -2 * std::sin(0.5), 0);  // the laser is 1 m ahead
  EXPECT_LT((scan.points[0].cast<double>() - first).norm(), 1e-6);
  EXPECT_LT((scan.points[1] - Eigen::Vector3f(3, 0, 0)).norm(), 1e-6);
  EXPECT_EQ(scan.intensities, (std::vector<float>{7, 8}));
}

TEST(Carmen, ARearScannerLooksBackwards) {
  const auto imported =
      read_carmen("PARAM robot_rearlaser_offset -0.25 nohost 0\nRLASER 3 1 2 99 0 0 0 0 0 0 1 h 0\n");
  const LidarScan scan = imported.mission.robots[0].lidar.read(0);
  ASSERT_EQ(scan.points.size(), 2U);
  EXPECT_LT((scan.points[1] - Eigen::Vector3f(-2.25F, 0, 0)).norm(), 1e-6);
}

TEST(Carmen, RefusesWithTheLine) {
  const std::string good = flaser("1 2 3", "0 0 0", "10");
  expect_refusal([&] { read_carmen("PARAM x y\n"); }, 0, "contains no scans");
  expect_refusal([&] { read_carmen("FLASER 3 1 2 3 0 0 0 0 0\n"); }, 1, "ends before");
  expect_refusal([&] { read_carmen("FLASER 3 1 2 x 0 0 0 0 0 0 1 h 0\n"); }, 1, "a reading 'x'");
  expect_refusal([&] { read_carmen("FLASER 99999999 1\n"); }, 1, "implausibly large");
  expect_refusal([&] { read_carmen(flaser("1 2 3", "0 0 0", "1e300")); }, 1, "ipc_timestamp");
  expect_refusal([&] { read_carmen(flaser("1 2 3", "0 0 0", "100") + good); }, 1,
                 "its time 100 is later than");
  expect_refusal([&] { read_carmen("ROBOTLASER1 0 0 1 1 9 0 0 1 1 0 0 0 0 0 0 0 1 2\n"); }, 1,
                 "ends before its");
}

TEST(Carmen, ABadLineIsLeftOutCountedAndNamed) {
  const auto imported = read_carmen(flaser("1 2 3", "0 0 0", "10") + "FLASER 3 1 2 x 0 0 0 0 0 0 1 h 0\n" +
                                    flaser("1 2 3", "1 0 0", "11"));
  EXPECT_EQ(imported.mission.robots[0].lidar.size(), 2U);
  ASSERT_EQ(imported.warnings.size(), 1U);
  EXPECT_NE(imported.warnings[0].find(":2: a reading 'x'"), std::string::npos) << imported.warnings[0];
}

TEST(Carmen, AStrayStampCostsItsLineOnly) {
  std::string log;
  for (int k = 0; k < 12; ++k) log += flaser("1 2 3", "0 0 0", k == 5 ? "900" : std::to_string(10 + k));
  const auto imported = read_carmen(log);
  EXPECT_EQ(imported.mission.robots[0].lidar.size(), 11U);
  ASSERT_EQ(imported.warnings.size(), 1U);
  EXPECT_NE(imported.warnings[0].find(":6: its time 900 is not in order"), std::string::npos);
}

std::size_t points_of(const LidarLog& log) {
  std::size_t points = 0;
  for (std::size_t k = 0; k < log.size(); ++k) points += log.read(k).points.size();
  return points;
}

/// 13,631 lines, 68,313 readings of 81.83 m and no other above 29 m, counted by hand.
TEST(Carmen, ReadsTheRecordedLaboratory) {
  RADIOSLAM_RECORDED(file, "lidar2d/intel.clf.bz2");
  const auto imported = read_carmen(read_compressed_text(file), "a");
  const Robot& robot = imported.mission.robots[0];
  EXPECT_EQ(robot.lidar.size(), 13631U);
  EXPECT_EQ(points_of(robot.lidar), 13631U * 180U - 68313U);
}

/// Each of the 1,279 reference relations is between two scans of exactly its times.
TEST(Carmen, StampsOfTheRecordedHallAreThoseOfItsRelations) {
  RADIOSLAM_RECORDED(file, "lidar2d/aces.clf.bz2");
  const auto imported = read_carmen(read_compressed_text(file), "a");
  const LidarLog& log = imported.mission.robots[0].lidar;
  EXPECT_TRUE(imported.warnings.empty());
  EXPECT_EQ(points_of(log), 7374U * 180U - 11139U) << "readings of 50 m";
  const std::set<Stamp> stamps(log.stamps.begin(), log.stamps.end());
  const Text relations = read_text(recorded_data("lidar2d/aces.relations"));
  TextLines lines(relations);
  std::size_t matched = 0;
  while (lines.next_with_content()) {
    LineFields fields(lines);
    const Stamp first = fields.stamp("t1");
    const Stamp second = fields.stamp("t2");
    if (stamps.contains(first) && stamps.contains(second)) ++matched;
  }
  EXPECT_EQ(matched, 1279U);
}

}  // namespace
}  // namespace radioslam
