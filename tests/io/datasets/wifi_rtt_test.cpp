#include "radioslam/io/datasets/wifi_rtt.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "io/recorded_data.hpp"
#include "io/refusal.hpp"

namespace radioslam {
namespace {

std::string header(const std::string& phone) {
  std::string line = phone + " Time Stamp (ms)";
  for (const char* ap : {"AP1", "AP2"})
    line += std::string(",") + ap + " True Distance (m)," + ap + " RTT Distance (m)," + ap + " RTT std (m)," +
            ap + " RSS (dBm)";
  return line + ",AccX," + phone + " Ground Truth\n";
}

const std::string kAnchors = "\xef\xbb\xbf,x,y\nAP1,30.84,6.75\nAP2,0,0\n";
const std::string kBetween =
    "Time Stamp (ms),M1-M2 RTT Distance (m),RTT std (m),RSS (dBm)\n1048,42.851,0.2,-68\n2116,0,0,-69\n";

ImportedMission read_trial(const std::string& first, const std::string& second,
                           const std::string& between = kBetween) {
  WifiRttFiles files;
  files.phones.push_back(make_text("13.csv", first));
  files.phones.push_back(make_text("24.csv", second));
  files.anchors = make_text("AP.csv", kAnchors);
  files.between = make_text("log.csv", between);
  return mission_of_wifi_rtt(files, "walk");
}

TEST(WifiRtt, ReadsRangesLevelsAndTruth) {
  const ImportedMission imported = read_trial(
      header("M1") +
          "0,9,12.75,2.5,-83,0,0,0,0,0.1,\"[22.995, 11.15]\"\n275.5,9,0,0.1,-64,3,4,0,-50,0.1,\"[23, 11]\"\n",
      header("M2") + "10,9,12.5,0.1,-83,0,-3,0.1,0,0.1,\"[1, 2]\"\n");
  const Mission& mission = imported.mission;
  ASSERT_EQ(mission.robots.size(), 2U);
  EXPECT_EQ(mission.robots[0].id, "M1");
  ASSERT_EQ(mission.anchors.size(), 2U);
  EXPECT_EQ(*mission.anchors[0].position_m, Eigen::Vector3d(30.84, 6.75, 0));
  ASSERT_EQ(mission.ranges.size(), 4U);
  EXPECT_EQ(mission.ranges[0].range_m, 12.75);
  EXPECT_EQ(mission.ranges[0].sigma_m, 2.5);
  EXPECT_EQ(mission.ranges[1].sigma_m, 0.3);  // a spread of 0.1 m
  EXPECT_EQ(mission.ranges[2].stamp.ns, 275'500'000);
  EXPECT_EQ(mission.ranges[2].sigma_m, 1);  // no spread
  EXPECT_EQ(mission.ranges[3].j.robot.index(), 1U);
  EXPECT_EQ(mission.ranges[3].range_m, 42.851);
  ASSERT_EQ(mission.robots[0].wifi.size(), 2U);
  EXPECT_EQ(mission.robots[0].wifi[1].readings.size(), 2U);
  EXPECT_EQ(mission.access_points, (std::vector<std::string>{"ap1", "ap2"}));
  EXPECT_EQ((*imported.truth.robots[0].poses.begin()).pose.translation(), Eigen::Vector3d(22.995, 11.15, 0));
  EXPECT_EQ(imported.warnings, (std::vector<std::string>{"1 distances are implausible and left out"}));
}

TEST(WifiRtt, RefusesOtherTables) {
  const std::string good = header("M1") + "0,9,12,2,-83,0,0,0,0,0,\"[2, 1]\"\n";
  expect_refusal([&] { read_trial(header("M1"), good); }, 1, "no rows");
  expect_refusal([&] { read_trial("M1 Time Stamp (ms),M1 Ground Truth\n", good); }, 1,
                 "no columns of an access point");
  expect_refusal([&] { read_trial(header("M1") + "0,9,12,2,-83,0,0,0,0,0,2,1\n", good); }, 2, "12 fields");
  expect_refusal([&] { read_trial(header("M1") + "0,9,12,2,-83,0,0,0,0,0,here\n", good); }, 2,
                 "not of the form [x, y]");
  expect_refusal([&] { read_trial(header("M1") + "0,9,12,2,-183,0,0,0,0,0,\"[2, 1]\"\n", good); }, 2,
                 "implausible");
  expect_refusal([&] { read_trial(header("M1") + "-1,9,12,2,-83,0,0,0,0,0,\"[2, 1]\"\n", good); }, 2,
                 "time is implausible");
  expect_refusal([] { import_wifi_rtt("/nowhere"); }, 0, "is not a folder");
}

TEST(WifiRtt, LeavesOutABadRowAndSortsALateOne) {
  const std::string good = header("M1") + "0,9,12,2,-83,0,0,0,0,0,\"[2, 1]\"\n";
  const std::string late =
      header("M2") + "5,9,1,2,-8,0,0,0,0,0,\"[2, 1]\"\n4,9,1,2,-8,0,0,0,0,0,\"[3, 1]\"\n";
  const auto imported = read_trial(good + "0,far\n", late);
  EXPECT_EQ(imported.truth.robots.at(1).poses.front().pose.translation().x(), 3);
  ASSERT_EQ(imported.warnings.size(), 2U);
  EXPECT_NE(imported.warnings[0].find("1 row is left out"), std::string::npos) << imported.warnings[0];
  EXPECT_NE(imported.warnings[1].find("were sorted"), std::string::npos) << imported.warnings[1];
}

/// According to the authors' true distances the phones' bias is 0.85 m in the car park.
TEST(WifiRtt, TheRecordedCarParksRangesHaveItsBias) {
  RADIOSLAM_RECORDED(folder, "wifi_rtt/CarPark/5");
  const ImportedMission imported = import_wifi_rtt(folder);
  const Mission& mission = imported.mission;
  std::vector<double> errors_m;
  std::size_t between = 0;
  for (const RangeMeasurement& range : mission.ranges) {
    if (range.j.robot.valid()) {
      ++between;
      continue;
    }
    const auto pose = imported.truth.robots[range.i.robot.index()].poses.at(range.stamp);
    ASSERT_TRUE(pose);
    errors_m.push_back(range.range_m -
                       (pose->translation() - *mission.anchors[range.j.anchor.index()].position_m).norm());
  }
  EXPECT_EQ(between, 304U);
  ASSERT_GT(errors_m.size(), 5000U);
  std::nth_element(errors_m.begin(), errors_m.begin() + static_cast<std::ptrdiff_t>(errors_m.size() / 2),
                   errors_m.end());
  EXPECT_NEAR(errors_m[errors_m.size() / 2], 0.85, 0.1);
}

}  // namespace
}  // namespace radioslam
