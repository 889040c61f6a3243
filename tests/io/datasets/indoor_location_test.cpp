#include "radioslam/io/datasets/indoor_location.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "io/recorded_data.hpp"
#include "io/refusal.hpp"
#include "io/temporary_folder.hpp"
#include "io/wifi/phone_log_text.hpp"
#include "radioslam/eval/metrics.hpp"
#include "radioslam/io/mission/mission_folder.hpp"

namespace radioslam {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;

/// A folder with one or more copies of the small log.
void write_logs(const TemporaryFolder& folder, const std::vector<std::string>& names) {
  for (const auto& name : names) folder.write(name, joined(phone_log_lines()));
}

TEST(ImportIndoorLocation, EveryLogIsARobotInTheOrderOfTheirNames) {
  const TemporaryFolder folder;
  write_logs(folder, {"site/B1/path_data_files/walk-b.txt", "site/B1/path_data_files/walk-a.txt"});
  folder.write("site/B1/floor_info.json", "{}");
  folder.write("site/B1/notes.txt", "not a log");
  const auto imported = import_indoor_location(folder.path() / "site/");
  EXPECT_EQ(imported.mission.name, "site");
  EXPECT_EQ(imported.mission.dimension, 2);
  ASSERT_EQ(imported.mission.robots.size(), 2U);
  EXPECT_EQ(imported.mission.robots[0].id, "walk-a");
  EXPECT_EQ(imported.truth.robots[1].id, "walk-b");
  EXPECT_EQ(imported.mission.robots[0].heading, Heading::kAbsolute);
}

TEST(ImportIndoorLocation, TheOdometryCoversTheWholeLogAndStartsAtTheOrigin) {
  const TemporaryFolder folder;
  const auto imported = import_indoor_location(folder.write("walk.txt", joined(phone_log_lines())));
  ASSERT_EQ(imported.mission.robots.size(), 1U);
  EXPECT_EQ(imported.mission.name, "walk");
  const auto& odometry = imported.mission.robots[0].odometry;
  EXPECT_EQ(odometry.front().stamp.ns, 1574242584992 * kMillisecond);
  EXPECT_EQ(odometry.back().stamp.ns, 1574242586500 * kMillisecond);
  EXPECT_EQ(odometry.front().pose.translation(), Eigen::Vector3d(0, 0, 0));
}

TEST(ImportIndoorLocation, TheTruthIsTheWaypoints) {
  const TemporaryFolder folder;
  const auto imported = import_indoor_location(folder.write("walk.txt", joined(phone_log_lines())));
  const auto& truth = imported.truth.robots.at(0);
  EXPECT_FALSE(truth.has_orientation);
  ASSERT_EQ(truth.poses.size(), 2U);
  EXPECT_EQ(truth.poses[1].stamp.ns, 1574242586500 * kMillisecond);
  EXPECT_EQ(truth.poses[1].pose.translation(), Eigen::Vector3d(205.5, 288, 0));
}

TEST(ImportIndoorLocation, LeavesOutEntriesFromBeforeTheWalk) {
  const TemporaryFolder folder;
  const auto imported = import_indoor_location(folder.write("walk.txt", joined(phone_log_lines())));
  EXPECT_EQ(imported.mission.access_points,
            (std::vector<std::string>{"0a:74:9c:a7:b2:e4", "0e:74:9c:a7:b2:e4"}));
  ASSERT_EQ(imported.mission.robots[0].wifi.size(), 1U);
  const auto& readings = imported.mission.robots[0].wifi[0].readings;
  ASSERT_EQ(readings.size(), 2U);
  EXPECT_EQ(readings[0].access_point.index(), 0U);
  EXPECT_EQ(readings[0].rssi_dbm, -60);
  EXPECT_EQ(readings[1].rssi_dbm, -43);
}

TEST(ImportIndoorLocation, OfAnAccessPointHeardTwiceTheStrongestReadingStays) {
  const TemporaryFolder folder;
  auto lines = phone_log_lines();
  lines[10] = "1574242586000\tTYPE_WIFI\tcafe\t0e:74:9c:a7:b2:e4\t-40\t5805\t1574242585900";
  const auto imported = import_indoor_location(folder.write("walk.txt", joined(lines)));
  ASSERT_EQ(imported.mission.robots[0].wifi[0].readings.size(), 1U);
  EXPECT_EQ(imported.mission.robots[0].wifi[0].readings[0].rssi_dbm, -40);
}

TEST(ImportIndoorLocation, WarnsOfWhatIsMissing) {
  const TemporaryFolder folder;
  std::vector<std::string> bare;
  for (const auto& line : phone_log_lines())
    if (line.find("GYRO") != std::string::npos || line.find("ACCEL") != std::string::npos)
      bare.push_back(line);
  const auto imported = import_indoor_location(folder.write("walk.txt", joined(bare)));
  EXPECT_EQ(imported.mission.robots[0].heading, Heading::kRelative);
  EXPECT_TRUE(imported.truth.empty());
  ASSERT_EQ(imported.warnings.size(), 4U);
  EXPECT_EQ(imported.warnings[0], "walk: the log has no end time; the recording may have been cut off");
  EXPECT_EQ(imported.warnings[3], "walk: no WiFi scans");
}

TEST(ImportIndoorLocation, RefusesASourceWithoutLogs) {
  const TemporaryFolder folder;
  folder.write("elsewhere/walk.txt", joined(phone_log_lines()));
  expect_refusal([&] { import_indoor_location(folder.path()); }, 0, "contains no log");
  expect_refusal([&] { import_indoor_location(folder.path() / "nothing"); }, 0, "");
}

TEST(ImportIndoorLocation, RefusesASecondFloor) {
  const TemporaryFolder folder;
  write_logs(folder, {"B1/path_data_files/a.txt", "F1/path_data_files/b.txt"});
  expect_refusal([&] { import_indoor_location(folder.path()); }, 0, "one floor at a time");
}

TEST(ImportIndoorLocation, RefusesANameThatCannotBeAFolders) {
  const TemporaryFolder folder;
  const auto file = folder.write("a walk.txt", joined(phone_log_lines()));  // the only one
  expect_refusal([&] { import_indoor_location(file); }, 0, "is not a valid robot name");
}

TEST(ImportIndoorLocation, OneBadLogOfManyIsLeftOutAndNamed) {
  const TemporaryFolder folder;
  write_logs(folder, {"path_data_files/a.txt", "path_data_files/c.txt"});
  folder.write("path_data_files/b.txt", "no log at all\n");
  const auto imported = import_indoor_location(folder.path());
  EXPECT_EQ(imported.mission.robots.size(), 2U);
  ASSERT_FALSE(imported.warnings.empty());
  EXPECT_NE(imported.warnings[0].find("1 walk is left out; the first: "), std::string::npos);
  EXPECT_NE(imported.warnings[0].find("b.txt:1: "), std::string::npos);
}

TEST(ImportIndoorLocation, NamesTheFileAndTheLineOfARecordThatItLeavesOut) {
  const TemporaryFolder folder;
  write_logs(folder, {"path_data_files/a.txt"});
  folder.write("path_data_files/b.txt", joined(phone_log_lines()) + "torn");
  const auto imported = import_indoor_location(folder.path());
  EXPECT_EQ(imported.mission.robots.size(), 2U);
  const auto named =
      std::count_if(imported.warnings.begin(), imported.warnings.end(), [](const auto& warning) {
        return warning.find("1 record is left out; the first: ") != std::string::npos &&
               warning.find("b.txt:15: ") != std::string::npos;
      });
  EXPECT_EQ(named, 1);
}

TEST(ImportIndoorLocation, IsReadBackAsItWasWritten) {
  const TemporaryFolder folder;
  write_logs(folder, {"path_data_files/a.txt", "path_data_files/b.txt"});
  const auto imported = import_indoor_location(folder.path());
  const TemporaryFolder written;
  write_mission(written.path(), imported.mission, imported.truth);
  const Mission mission = read_mission(written.path());
  const Truth truth = read_truth(written.path(), mission);
  ASSERT_EQ(mission.robots.size(), 2U);
  const auto& robot = mission.robots[1];
  EXPECT_EQ(robot.heading, Heading::kAbsolute);
  EXPECT_EQ(robot.odometry_noise.sigma_scale, 0.1);
  EXPECT_EQ(robot.odometry_noise.sigma_yaw_drift_per_m_rad,
            imported.mission.robots[1].odometry_noise.sigma_yaw_drift_per_m_rad);
  EXPECT_EQ(robot.sigma_heading_rad, imported.mission.robots[1].sigma_heading_rad);
  EXPECT_EQ(robot.odometry.size(), imported.mission.robots[1].odometry.size());
  EXPECT_EQ(robot.wifi.size(), 1U);
  EXPECT_FALSE(truth.robots[0].has_orientation);
  EXPECT_EQ(truth.robots[0].poses.size(), 2U);
}

/// Errors of dead reckoning at the waypoints and of its heading, with each walk aligned separately.
struct WalkErrors {
  std::vector<double> positions_m;
  std::vector<double> headings_rad;
};

WalkErrors errors_of_single_walks(const ImportedMission& imported) {
  WalkErrors errors;
  for (std::size_t r = 0; r < imported.mission.robots.size(); ++r) {
    const auto& robot = imported.mission.robots[r];
    const auto metrics = evaluate_trajectories({{robot.id, robot.odometry}}, {{imported.truth.robots[r]}}, 2);
    for (const auto& error : metrics.robots[0].errors) errors.positions_m.push_back(error.error_m);
    errors.headings_rad.push_back(std::abs(metrics.T_truth_estimate.yaw()));
  }
  return errors;
}

TEST(ImportIndoorLocation, RecordedWalksKeepTheirShapeAndHeading) {
  RADIOSLAM_RECORDED(data, "ilc20");
  const auto imported = import_indoor_location(data);
  EXPECT_EQ(imported.mission.robots.size(), 65U);
  EXPECT_TRUE(imported.warnings.empty());
  std::size_t scans = 0;
  for (const auto& robot : imported.mission.robots) scans += robot.wifi.size();
  EXPECT_EQ(scans, 909U);  // of 911; two contain only entries of the previous walk

  auto errors = errors_of_single_walks(imported);
  const auto shape = summarise_errors(errors.positions_m);
  ASSERT_TRUE(shape);
  EXPECT_EQ(shape->count, 444U);
  EXPECT_LT(shape->median_m, 1.6);
  EXPECT_LT(shape->p90_m, 3.5);
  std::sort(errors.headings_rad.begin(), errors.headings_rad.end());
  EXPECT_LT(quantile(errors.headings_rad, 0.5), 0.25);
  RecordProperty("shape_median_m", std::to_string(shape->median_m));
  RecordProperty("shape_mean_m", std::to_string(shape->mean_m));
  RecordProperty("shape_p90_m", std::to_string(shape->p90_m));
}

}  // namespace
}  // namespace radioslam
