// radioslam import carmen, kitti, rosbag: recordings with LiDAR scans become a mission.
#include <gtest/gtest.h>

#include "cli/import_fixture.hpp"
#include "io/ros/ros_bytes.hpp"

namespace radioslam::cli {
namespace {

const std::string kHallLog =
    "FLASER 3 1 2 3 0 0 0 5 5 0 10 nohost 0\nFLASER 3 1 9 3 0 0 0 6 5 0 12 nohost 0\n"
    "FLASER 3 1 2 3 0 0 0 7 5 0 11.5 nohost 0\n";

using ImportLidar = ImportFixture;

TEST_F(ImportLidar, CarmenBecomesAMissionThatRuns) {
  write_file(folder.path() / "hall.clf", kHallLog);
  const Outcome outcome = import({"carmen", "hall.clf", "--robot", "scout", "-o", "m"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out,
            "note: 1 scans are stamped later than a following one and were moved to before it\n"
            "m: 3 scans and odometry of scout\n");
  EXPECT_EQ(files_in(folder.path() / "m"),
            (std::vector<std::string>{"mission.yaml", "robots/scout/lidar/10000000000.bin",
                                      "robots/scout/lidar/11499999000.bin",
                                      "robots/scout/lidar/11500000000.bin", "robots/scout/odometry.tum"}));
  EXPECT_EQ(read_file(folder.path() / "m/robots/scout/lidar/11499999000.bin").size(), 32U)
      << "the 9 m reading is the log's largest: no return";
  EXPECT_NE(read_file(folder.path() / "m/mission.yaml").find("name: hall\ndimension: 2\n"),
            std::string::npos);
  const Outcome ran = run({"run", "m", "-o", "out"}, folder.path());
  EXPECT_EQ(ran.status, 0) << ran.err;
}

TEST_F(ImportLidar, CarmenRefusesWithTheLine) {
  write_file(folder.path() / "hall.clf", "FLASER 3 1 2\n");
  expect_refused({"carmen", "hall.clf", "-o", "m"}, "hall.clf:1: ");
  expect_refused({"carmen", "none.clf", "-o", "m"}, "none.clf: no such file");
  expect_refused({"carmen", "hall.clf", "--robot", "a/b", "-o", "m"}, "is not a valid name of a robot");
  expect_refused({"carmen", "hall.clf", "--time", "1", "-o", "m"}, "takes no --time");
  write_file(folder.path() / "late.clf", kHallLog);
  expect_refused({"carmen", "late.clf", "--set", "max_delay_s=0.1", "-o", "m"}, "late.clf:2: its time 12");
}

TEST_F(ImportLidar, KittiCopiesScansByteForByte) {
  std::filesystem::create_directories(folder.path() / "drive/bin");
  const std::string point = "0123456789abcdef";
  write_file(folder.path() / "drive/bin/000000.bin", point);
  write_file(folder.path() / "drive/bin/000001.bin", "");
  write_file(folder.path() / "drive/times.txt", "1630577758.569490\n1630577759.068947\n");
  write_file(folder.path() / "truth.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 5 0 1 0 6 0 0 1 7\n");
  const Outcome outcome = import({"kitti", "drive/", "--poses", "truth.txt", "-o", "m"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(
      outcome.out,
      "note: the ground truth is truth.txt, with poses of the LiDAR\nm: 2 scans of a, with ground truth\n");
  EXPECT_EQ(read_file(folder.path() / "m/robots/a/lidar/1630577758569490000.bin"), point);
  EXPECT_EQ(read_file(folder.path() / "m/robots/a/lidar/1630577759068947000.bin"), "");
  EXPECT_EQ(read_file(folder.path() / "m/robots/a/groundtruth.tum"),
            "1630577758.56949 0 0 0 0 0 0 1\n1630577759.068947 5 6 7 0 0 0 1\n");
  EXPECT_NE(read_file(folder.path() / "m/mission.yaml").find("name: drive\ndimension: 3\n"),
            std::string::npos);
}

TEST_F(ImportLidar, KittiRefusesInvalidFolders) {
  write_file(folder.path() / "scans.tar.zst", "x");
  expect_refused({"kitti", "scans.tar.zst", "-o", "m"}, "archives have to be unpacked first");
  expect_refused({"kitti", "none", "-o", "m"}, "none: no such folder");
  expect_refused({"kitti", ".", "-o", "m"}, "contains no scans");
}

/// Odometry of two robots, in one recording.
std::string recording_of_two() {
  RosBytes bytes(MessageEncoding::kRos1);
  bytes.header(10, 0, "odom").text("base").f64s({1, 2, 0, 0, 0, 0, 1});
  return bag_of(bag_records({{"/r1/odom", "nav_msgs/Odometry", 9, bytes.bytes()},
                             {"/r2/odom", "nav_msgs/Odometry", 9, bytes.bytes()}}));
}

TEST_F(ImportLidar, RosbagListsTopics) {
  write_file(folder.path() / "x.bag", recording_of_two());
  const Outcome outcome = import({"rosbag", "x.bag", "--list"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "/r1/odom  nav_msgs/Odometry  1\n/r2/odom  nav_msgs/Odometry  1\n");
}

TEST_F(ImportLidar, RosbagOfATeamBecomesOneMission) {
  write_file(folder.path() / "x.bag", recording_of_two());
  const Outcome outcome = import({"rosbag", "x.bag", "x.bag", "--robot", "r1", "--robot", "r2", "--odometry",
                                  "/r1/odom", "--odometry", "/r2/odom", "-o", "team"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(files_in(folder.path() / "team"),
            (std::vector<std::string>{"mission.yaml", "robots/r1/odometry.tum", "robots/r2/odometry.tum"}));
  EXPECT_EQ(read_file(folder.path() / "team/robots/r2/odometry.tum"), "10 0 0 0 0 0 0 1\n");
}

TEST_F(ImportLidar, RosbagBringsWifiScans) {
  RosBytes odometry(MessageEncoding::kRos1), scan(MessageEncoding::kRos1);
  odometry.header(10, 0, "odom").text("base").f64s({1, 2, 0, 0, 0, 0, 1});
  scan.u32(2).text("02:AA:00:00:01:00").u32(0x100000000 - 50).text("02:AA:00:00:02:00").u32(80);
  const WrittenMessage wifi{
      "/wifi_fp", "wifi_scan/Fingerprint", 9'000'000'000, scan.bytes(),
      "AddressRSSI[] list\n===\nMSG: wifi_scan/AddressRSSI\nstring address\nint32 rssi\n"};
  WrittenMessage other = wifi;
  other.topic = "/wifi_other";
  const WrittenMessage pose{"/odom", "nav_msgs/Odometry", 10'000'000'000, odometry.bytes()};
  write_file(folder.path() / "x.bag", bag_of(bag_records({pose, wifi})));
  write_file(folder.path() / "y.bag", bag_of(bag_records({pose, wifi, other})));
  const Outcome outcome = import({"rosbag", "x.bag", "-o", "m"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("1 odometry samples, 0 IMU samples, 1 rows, 1 scans, 1 radios of a"),
            std::string::npos)
      << outcome.out;
  EXPECT_NE(outcome.out.find("/wifi_fp: 1 readings without an address or a level in dBm are left out"),
            std::string::npos)
      << outcome.out;
  const std::string table = "t_s,bssid,frequency_mhz,rssi_dbm\n9,02:aa:00:00:01:00,0,-50\n";
  EXPECT_EQ(read_file(folder.path() / "m/robots/a/wifi.csv"), table);
  expect_refused({"rosbag", "y.bag", "-o", "n"}, "has 2 topics with WiFi readings; --wifi selects one");
  EXPECT_EQ(import({"rosbag", "y.bag", "--wifi", "/wifi_other", "-o", "n"}).status, 0);
  EXPECT_EQ(read_file(folder.path() / "n/robots/a/wifi.csv"), table);
}

/// A robot's odometry and one position fix at the given latitude.
std::string recording_with_fix(double latitude_deg) {
  RosBytes odometry(MessageEncoding::kRos1), fix(MessageEncoding::kRos1);
  odometry.header(10, 0, "odom").text("base").f64s({1, 2, 0, 0, 0, 0, 1});
  fix.header(10, 0, "base").u8(0).u16(1).f64s({latitude_deg, 0, 0}).f64s(std::vector<double>(9, 4)).u8(2);
  return bag_of(bag_records({{"/odom", "nav_msgs/Odometry", 9, odometry.bytes()},
                             {"/fix", "sensor_msgs/NavSatFix", 9, fix.bytes()}}));
}

TEST_F(ImportLidar, RosbagBringsFixesOfATeamIntoOneFrame) {
  write_file(folder.path() / "x.bag", recording_with_fix(0));
  write_file(folder.path() / "y.bag", recording_with_fix(0.001));
  const Outcome outcome = import({"rosbag", "x.bag", "y.bag", "-o", "team"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("1 odometry samples, 0 IMU samples, 1 position fixes of y\n"), std::string::npos)
      << outcome.out;
  EXPECT_EQ(read_file(folder.path() / "team/robots/x/gnss.csv"), "t_s,x_m,y_m,z_m,sigma_m\n10,0,0,0,2\n");
  const std::string other = read_file(folder.path() / "team/robots/y/gnss.csv");
  EXPECT_NE(other.find("\n10,0,110.57"), std::string::npos) << other;
  ASSERT_EQ(import({"rosbag", "x.bag", "--gnss", "none", "-o", "alone"}).status, 0);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "alone/robots/a/gnss.csv"));
}

TEST_F(ImportLidar, RosbagMakesARobotOfEachOdometryThatIsNamed) {
  write_file(folder.path() / "x.bag", recording_of_two());
  const Outcome outcome =
      import({"rosbag", "x.bag", "--odometry", "/r1/odom", "--odometry", "/r2/odom", "-o", "team"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(files_in(folder.path() / "team"),
            (std::vector<std::string>{"mission.yaml", "robots/r1/odometry.tum", "robots/r2/odometry.tum"}))
      << "named by what differs in the topics";
}

/// Odometry, and ranges of a topic.
std::string recording_with_ranges(const std::string& topic) {
  RosBytes odometry(MessageEncoding::kRos1), range(MessageEncoding::kRos1);
  odometry.header(10, 0, "odom").text("base").f64s({1, 2, 0, 0, 0, 0, 1});
  range.header(10, 500'000'000, "").u8(1).f32(0).f32(0).f32(0).f32(4.5F);
  return bag_of(bag_records({{"/odom", "nav_msgs/Odometry", 10'000'000'000, odometry.bytes()},
                             {"/rosout", "rosgraph_msgs/Log", 10'000'000'000, ""},
                             {topic, "sensor_msgs/Range", 10'000'000'000, range.bytes()}}));
}

TEST_F(ImportLidar, RosbagTakesAFolderOfBagsWithRanges) {
  std::filesystem::create_directories(folder.path() / "bags");
  write_file(folder.path() / "bags/north.bag", recording_with_ranges("/uwb/south"));
  write_file(folder.path() / "bags/south.bag", recording_with_ranges("/uwb/tag_9"));
  const Outcome outcome = import({"rosbag", "bags", "--name", "tag_9=door", "-o", "team"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(read_file(folder.path() / "team/radio/ranges.csv"),
            "t_s,robot_i,robot_j,range_m,sigma_m\n10.5,north,south,4.5,0.1\n10.5,south,door,4.5,0.1\n");
  EXPECT_NE(read_file(folder.path() / "team/radio/anchors.csv").find("\ndoor,,,"), std::string::npos);
  EXPECT_NE(
      outcome.out.find("bags/north.bag: topics that are not imported: /rosout (rosgraph_msgs/Log, 1)\n"),
      std::string::npos)
      << outcome.out;
  ASSERT_EQ(import({"rosbag", "bags", "--ranges", "/uwb/tag_9=south,gate", "-o", "other"}).status, 0);
  EXPECT_NE(read_file(folder.path() / "other/radio/ranges.csv").find("south,gate,4.5"), std::string::npos);
  const Outcome listed = import({"rosbag", "bags", "--list"});
  EXPECT_NE(listed.out.find("bags/south.bag:\n/odom  nav_msgs/Odometry  1\n"), std::string::npos)
      << listed.out;
}

TEST_F(ImportLidar, RosbagRefusesInvalidRadios) {
  write_file(folder.path() / "x.bag", recording_of_two());
  const auto refuse = [&](const char* option, const char* value, const char* words) {
    expect_refused({"rosbag", "x.bag", "--odometry", "/r1/odom", option, value, "-o", "m"}, words);
  };
  refuse("--name", "n_3", "--name n_3: expected RADIO=ID");
  refuse("--name", "n_3=a/b", "is not a valid name");
  refuse("--ranges", "/x", "--ranges /x: expected TOPIC=ID,ID");
  refuse("--ranges", "/x=a", "expected TOPIC=ID,ID");
  refuse("--ranges", "/x=b,c", "at least one of two different ends has to be a robot");
  expect_refused({"rosbag", "x.bag", "--odometry", "/r1/odom", "--name", "n=a", "--name", "n=b", "-o", "m"},
                 "this radio already has a name");
}

TEST_F(ImportLidar, RosbagRefusesAmbiguousTopics) {
  write_file(folder.path() / "x.bag", recording_of_two());
  expect_refused({"rosbag", "x.bag", "-o", "m"}, "x.bag: has 2 topics with odometry; --odometry selects one");
  expect_refused({"rosbag", "x.bag"}, "--output");
  expect_refused({"rosbag", "x.bag", "x.bag", "--robot", "a", "-o", "m"},
                 "2 sources but 1 --robot are given");
  expect_refused({"rosbag", "x.bag", "x.bag", "--robot", "a", "--robot", "a", "-o", "m"}, "the same name");
  expect_refused(
      {"rosbag", "x.bag", "x.bag", "x.bag", "--odometry", "/r1/odom", "--odometry", "/r2/odom", "-o", "m"},
      "--odometry: is given 2 times for 3 sources");
  expect_refused({"rosbag", "x.bag", "--set", "a=1", "-o", "m"}, "takes no parameters");
  expect_refused({"carmen", "x.bag", "--scans", "/x", "-o", "m"}, "takes no ROS topics");
  expect_refused({"iw", "x.bag", "--robot", "a", "--robot", "b", "-o", "m"}, "takes no second --robot");
}

}  // namespace
}  // namespace radioslam::cli
