#include "radioslam/io/datasets/wifine.hpp"

#include <gtest/gtest.h>

#include "io/refusal.hpp"
#include "io/temporary_folder.hpp"
#include "radioslam/io/mission/mission_folder.hpp"

namespace radioslam {
namespace {

const std::string kHeader = "0,1,2,num_visible_APs,timestamp,x,y,z,floorID\n";

ImportedMission read_walk(const std::string& content) {
  return mission_of_wifine({{"a", make_text("a.csv", content)}}, "m");
}

TEST(Wifine, EveryTrajectoryIsARobotWithTruthAndScans) {
  const ImportedMission imported =
      mission_of_wifine({{"a", make_text("a.csv", kHeader + "-57.0,-100.0,-83.5,2,0.0,13.8,1.5,1.4,0\n"
                                                            "-100.0,-100.0,-100.0,0,4.5,14.0,2.0,1.4,0\n")},
                         {"b", make_text("b.csv", kHeader + "-100.0,-60.0,-100.0,1,0.0,1,2,5.4,1\n")}},
                        "walks");
  ASSERT_EQ(imported.mission.robots.size(), 2U);
  EXPECT_EQ(imported.mission.dimension, 3);
  EXPECT_EQ(imported.mission.access_points, (std::vector<std::string>{"ap0", "ap1", "ap2"}));
  const Robot& a = imported.mission.robots[0];
  ASSERT_EQ(a.wifi.size(), 1U);  // the second row has no readings
  ASSERT_EQ(a.wifi[0].readings.size(), 2U);
  EXPECT_EQ(a.wifi[0].readings[1].access_point.index(), 2U);
  EXPECT_EQ(a.wifi[0].readings[1].rssi_dbm, -83.5F);
  ASSERT_EQ(imported.truth.robots[0].poses.size(), 2U);
  EXPECT_EQ((*imported.truth.robots[0].poses.begin()).pose.translation(), Eigen::Vector3d(13.8, 1.5, 1.4));
  EXPECT_FALSE(imported.truth.robots[0].has_orientation);
}

TEST(Wifine, BecomesAMissionWhenThereIsOdometry) {
  const TemporaryFolder folder;
  const ImportedMission imported = read_walk(kHeader + "-57.0,-100.0,-83.5,2,0.0,13.8,1.5,1.4,0\n");
  write_mission(folder.path(), imported.mission, imported.truth);
  expect_refusal([&] { read_mission(folder.path()); }, 5, "has no robots/a/odometry.tum");
  folder.write("robots/a/odometry.tum", "0 0 0 0 0 0 0 1\n");
  const Mission mission = read_mission(folder.path());
  EXPECT_EQ(mission.robots.at(0).wifi.size(), 1U);
  EXPECT_EQ(read_truth(folder.path(), mission).robots.at(0).poses.size(), 1U);
}

TEST(Wifine, LeavesOutBadRowsAndSecondOnesOfATime) {
  const std::string row = "-5,-5,-5,3,1,1,1,1,0\n";
  const auto imported = read_walk(kHeader + row + "-5,-5,-5,2,2,1,1,1,0\n" + "-5,-5,-5,3,2,1,1,1,0\n" + row);
  EXPECT_EQ(imported.mission.robots.at(0).wifi.size(), 2U);
  ASSERT_EQ(imported.warnings.size(), 1U);
  EXPECT_NE(imported.warnings[0].find(" 2 rows are left out; the first: "), std::string::npos)
      << imported.warnings[0];
}

TEST(Wifine, RefusesOtherTables) {
  expect_refusal([] { read_walk("a,b\n"); }, 1, "not that of WiFine");
  expect_refusal([] { read_walk("0,2,num_visible_APs,timestamp,x,y,z,floorID\n"); }, 1, "not that of WiFine");
  expect_refusal([] { read_walk(kHeader); }, 1, "no rows");
  expect_refusal([] { read_walk(kHeader + "-57.0,-100.0,-83.5,2,0.0,13.8,1.5,1.4\n"); }, 2, "8 fields");
  expect_refusal([] { read_walk(kHeader + "-57.0,-100.0,-83.5,3,0.0,13.8,1.5,1.4,0\n"); }, 2,
                 "but 2 were received");
  expect_refusal([] { read_walk(kHeader + "57.0,-100.0,-83.5,2,0.0,13.8,1.5,1.4,0\n"); }, 2, "implausible");
  expect_refusal([] { import_wifine("/nowhere/train"); }, 0, "no such file");
}

}  // namespace
}  // namespace radioslam
