#include "radioslam/io/mission/mission_folder.hpp"

#include <cmath>
#include <limits>

#include "io/example_mission.hpp"
#include "io/refusal.hpp"
#include "radioslam/io/csi/intel5300.hpp"
#include "radioslam/io/mission/mission_yaml.hpp"
#include "radioslam/io/text/byte_view.hpp"
#include "radioslam/mission/wifi_channel.hpp"

namespace radioslam {
namespace {

Mission read_folder(const Files& files) {
  const TemporaryFolder folder;
  write_files(folder, files);
  return read_mission(folder.path());
}

/// All files that write_mission writes for a mission.
Files written(const Mission& mission, const Truth& truth = {}) {
  const TemporaryFolder folder;
  write_mission(folder.path(), mission, truth);
  Files files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path()))
    if (entry.is_regular_file()) {
      const auto name = std::filesystem::relative(entry.path(), folder.path());
      files[name.string()] = folder.read(name);
    }
  return files;
}

TEST(ReadMission, MergesDefaultsAndOverrides) {
  const Mission mission = read_folder(example_mission());
  EXPECT_EQ(mission.name, "example");
  EXPECT_EQ(mission.dimension, 2);
  ASSERT_EQ(mission.robots.size(), 2u);
  const Robot& a = mission.robots[0];
  const Robot& b = mission.robots[1];
  EXPECT_EQ(a.id, "a");
  EXPECT_EQ(a.odometry_noise.sigma_xy_per_sqrt_m, 0.05);
  EXPECT_EQ(a.odometry_noise.sigma_yaw_per_rad, OdometryNoise{}.sigma_yaw_per_rad);
  EXPECT_EQ(b.odometry_noise.sigma_xy_per_sqrt_m, 0.05);
  EXPECT_EQ(b.odometry_noise.sigma_yaw_per_rad, 0.3);
  EXPECT_EQ(b.odometry_noise.sigma_scale, 0.01);
  EXPECT_EQ(a.lidar_range_m, 12);
  EXPECT_EQ(a.heading, Heading::kRelative);
  EXPECT_EQ(b.heading, Heading::kAbsolute);
  EXPECT_EQ(b.sigma_heading_rad, 0.1);
  EXPECT_FALSE(a.initial_pose);
  ASSERT_TRUE(b.initial_pose);
  EXPECT_EQ(b.initial_pose->translation(), Eigen::Vector3d(1, 2, 0));
  EXPECT_NEAR(b.initial_pose->yaw(), 0.5, 1e-12);
}

TEST(ReadMission, SharesAccessPointsBetweenRobots) {
  const Mission mission = read_folder(example_mission());
  EXPECT_EQ(mission.access_points, (std::vector<std::string>{"aa:01", "aa:02"}));
  ASSERT_EQ(mission.robots[1].wifi.size(), 1u);
  EXPECT_EQ(mission.robots[1].wifi[0].readings[0].access_point, AccessPointIndex(1));
}

TEST(ReadMission, NeedsOnlyMissionYamlAndOdometry) {
  const Mission mission = read_folder({{"mission.yaml", "format: radioslam-mission/1\nrobots:\n  a:\n"},
                                       {"robots/a/odometry.tum", "0 0 0 0 0 0 0 1\n"}});
  EXPECT_EQ(mission.dimension, 2);
  EXPECT_FALSE(mission.name.empty());
  EXPECT_EQ(mission.robots[0].odometry.size(), 1u);
  EXPECT_TRUE(mission.robots[0].wifi.empty());
}

TEST(ReadMission, KnowsTheNamesOfATeamThatHasRecordedNothing) {
  Files files = example_mission();
  std::erase_if(files, [](const auto& file) {
    return file.first != "mission.yaml" && file.first != "radio/anchors.csv";
  });
  const TemporaryFolder folder;
  write_files(folder, files);
  EXPECT_THROW(read_mission(folder.path()), InputError);
  const MissionNames names = read_mission_names(folder.path());
  const Mission whole = read_folder(example_mission());
  ASSERT_EQ(names.mission.robots.size(), whole.robots.size());
  EXPECT_EQ(names.mission.robots[1].odometry_noise.sigma_yaw_per_rad, 0.3);
  ASSERT_EQ(names.mission.anchors.size(), whole.anchors.size());
  EXPECT_GT(names.mission.anchors.size(), 0U);
  EXPECT_EQ(names.antennas.size(), 2U);
}

TEST(ReadMission, ReadsByteOrderMarksAndCrLfAlike) {
  Files windows;
  for (const auto& [name, content] : example_mission()) {
    std::string& file = windows[name] = "\xef\xbb\xbf";
    for (const char c : content) file += c == '\n' ? std::string("\r\n") : std::string(1, c);
  }
  EXPECT_EQ(written(read_folder(windows)), written(read_folder(example_mission())));
}

TEST(ReadMission, IgnoresFilesOfOtherReaders) {
  Files files = example_mission();
  files["robots/a/csi/5300.dat"] = "anything";
  files["robots/a/lidar/README.md"] = "anything";
  files["robots/README.md"] = "anything";
  files["robots/.hidden/x"] = "anything";
  EXPECT_NO_THROW(read_folder(files));
}

TEST(ReadMission, AnAntennaNamedGnssIsWhereFixesAre) {
  Files files = example_mission();
  std::string& yaml = files["mission.yaml"];
  const std::string before = "front: [0.2, 0, 0.1]";
  yaml.replace(yaml.find(before), before.size(), before + ", gnss: [-0.5, 0.1, 1.5]");
  const Mission mission = read_folder(files);
  EXPECT_EQ(mission.robots[0].fix_lever_m, Eigen::Vector3d(-0.5, 0.1, 1.5));
  EXPECT_EQ(mission.robots[1].fix_lever_m, Eigen::Vector3d::Zero());
  EXPECT_NE(format_mission_yaml(mission).find("[-0.5, 0.1, 1.5]"), std::string::npos);
}

/// A capture with one packet of the given sender.
CsiCapture capture_of(std::uint64_t sender, std::uint32_t counter) {
  CsiCapture capture;
  capture.subcarrier_hz = grouped_subcarriers_hz(ChannelWidth::k20MHz);
  capture.bandwidth_hz = 20e6;
  CsiPacket& packet = capture.packets.emplace_back();
  packet.stamp = {1'500'000'000};
  packet.sender = MacAddress{sender};
  packet.counter = counter;
  packet.antennas = packet.streams = 1;
  packet.channel.setConstant(1, 30, {7, -7});
  return capture;
}

/// The example mission with a card on robot a, whose captures are two files, and an undescribed folder of
/// robot b.
Files mission_with_csi() {
  Files files = example_mission();
  std::string& yaml = files["mission.yaml"];
  const std::string before = "a: {antennas: {front: [0.2, 0, 0.1]}";
  yaml.replace(yaml.find(before), before.size(),
               "a: {csi: {mac: '00:16:EA:00:00:01', channel: 108, antennas: [rear, front]}, "
               "antennas: {front: [0.2, 0, 0.1], rear: [-0.2, 0, 0.1]}");
  files["robots/a/csi/2.dat"] = write_intel5300(capture_of(2, 22));
  files["robots/a/csi/1.dat"] = write_intel5300(capture_of(2, 11));
  files["robots/a/csi/.hidden"] = "anything";
  files["robots/b/csi/1.dat"] = "anything";
  return files;
}

TEST(ReadMission, ReadsTheCapturesOfCardsThatItDescribes) {
  const Mission mission = read_folder(mission_with_csi());
  ASSERT_TRUE(mission.robots[0].csi);
  const CsiRecording& csi = *mission.robots[0].csi;
  EXPECT_EQ(csi.address, MacAddress{0x0016ea000001});
  EXPECT_EQ(csi.carrier_hz, 5.54e9);
  ASSERT_EQ(csi.antennas_m.size(), 2U);
  EXPECT_EQ(csi.antennas_m[0], Eigen::Vector3d(-0.2, 0, 0.1));
  EXPECT_EQ(csi.antennas_m[1], Eigen::Vector3d(0.2, 0, 0.1));
  ASSERT_EQ(csi.captures.size(), 2U);
  EXPECT_EQ(csi.captures[0].packets[0].counter, 11U);
  EXPECT_EQ(csi.captures[1].packets[0].counter, 22U);
  EXPECT_FALSE(mission.robots[1].csi);
  EXPECT_EQ(mission.unused_files, std::vector<std::string>{"robots/b/csi"});
}

TEST(ReadMission, ACardWithoutAntennasHasOneAtTheBody) {
  Files files = example_mission();
  files["mission.yaml"] += "  csi: {channel: 6}\n";
  const Mission mission = read_folder(files);
  ASSERT_TRUE(mission.robots[1].csi);
  EXPECT_FALSE(mission.robots[1].csi->address);
  EXPECT_EQ(mission.robots[1].csi->carrier_hz, 2.437e9);
  EXPECT_EQ(mission.robots[1].csi->antennas_m, std::vector<Eigen::Vector3d>{Eigen::Vector3d::Zero()});
  EXPECT_TRUE(mission.robots[1].csi->captures.empty());
  EXPECT_EQ(written(read_folder(written(mission))), written(mission));
}

TEST(ReadMission, NamesTheFileThatIsNoCapture) {
  Files files = mission_with_csi();
  files["robots/a/csi/2.dat"] = "anything";
  EXPECT_NE(refusal([&] { read_folder(files); }).find("robots/a/csi/2.dat: at byte 0"), std::string::npos);
}

TEST(WriteMission, KeepsCardsAndTheirCaptures) {
  Files files = mission_with_csi();
  files["radio/ranges.csv"] =
      "t_s,robot_i,robot_j,range_m,sigma_m,antenna_i,antenna_j\n0.5,a,b,3,0.1,front,\n";
  const Mission mission = read_folder(files);
  const Files once = written(mission);
  EXPECT_EQ(once.at("robots/a/csi/capture-1.dat"), files.at("robots/a/csi/1.dat"));
  EXPECT_EQ(once.at("robots/a/csi/capture-2.dat"), files.at("robots/a/csi/2.dat"));
  EXPECT_EQ(once.count("robots/b/csi/1.dat"), 0U);
  EXPECT_NE(once.at("mission.yaml").find("antennas: [csi1, front]"), std::string::npos)
      << "no table names the rear one; the front one keeps its name";
  const Mission again = read_folder(once);
  EXPECT_EQ(again.robots[0].csi->address, mission.robots[0].csi->address);
  EXPECT_EQ(again.robots[0].csi->antennas_m, mission.robots[0].csi->antennas_m);
  EXPECT_EQ(again.ranges[0].i.antenna, "front");
  EXPECT_EQ(written(again), once);
}

TEST(ReadMission, TakesAMatchOfARobotWithItselfAndAnAnchorKnownExactly) {
  Files files = example_mission();
  files["matches.csv"] += "a,1,a,0,1,2,0,0,0,0,1,0.1,0.01\n";
  files["radio/anchors.csv"] += "A3,1,2,3,0\n";
  EXPECT_NO_THROW(read_folder(files));
}

/// Points in the format of a .bin scan.
std::string bin_of(const std::vector<Eigen::Vector3f>& points) {
  std::string bytes;
  for (const Eigen::Vector3f& point : points)
    for (const float number : {point.x(), point.y(), point.z(), 0.5F}) append_f32(bytes, number);
  return bytes;
}

constexpr const char* kImu =
    "t_s,ax_mps2,ay_mps2,az_mps2,wx_radps,wy_radps,wz_radps\n0.5,0.1,-0.2,9.81,0.01,0.02,-0.03\n"
    "1.500000001,1,2,3,4,5,6\n";

TEST(ReadMission, ReadsScansAndInertialReadings) {
  Files files = example_mission();
  files["robots/a/lidar/2000000000.bin"] = bin_of({{1, 2, 3}, {4, 5, 6}});
  files["robots/a/lidar/1000000000.bin"] = "";
  files["robots/a/imu.csv"] = kImu;
  const TemporaryFolder folder;
  write_files(folder, files);
  const Mission mission = read_mission(folder.path());
  const Robot& a = mission.robots[0];
  EXPECT_EQ(a.lidar.stamps, (std::vector<Stamp>{{1'000'000'000}, {2'000'000'000}}));
  EXPECT_TRUE(a.lidar.read(0).points.empty());
  EXPECT_EQ(a.lidar.read(1).points, (std::vector<Eigen::Vector3f>{{1, 2, 3}, {4, 5, 6}}));
  ASSERT_EQ(a.inertial.size(), 2U);
  EXPECT_EQ(a.inertial[0].specific_force_mps2, Eigen::Vector3d(0.1, -0.2, 9.81));
  EXPECT_EQ(a.inertial[1].angular_rate_radps, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(a.inertial[1].stamp, Stamp{1'500'000'001});
  EXPECT_TRUE(mission.robots[1].lidar.empty());
  EXPECT_TRUE(mission.unused_files.empty());
}

TEST(ReadMission, TakesScansInPlaceOfOdometry) {
  Files files = example_mission();
  files.erase("robots/b/odometry.tum");
  EXPECT_NE(
      refusal([&] { read_folder(files); }).find("mission.yaml:6: robot 'b' has no robots/b/odometry.tum"),
      std::string::npos);
  files["robots/b/lidar/1000000000.bin"] = bin_of({{1, 2, 3}});
  const Mission mission = read_folder(files);
  EXPECT_TRUE(mission.robots[1].odometry.empty());
  EXPECT_EQ(mission.robots[1].lidar.size(), 1U);
}

/// Two scans in memory, one with times and one without.
LidarLog two_scans() {
  LidarLog log;
  log.stamps = {{1'000'000'000}, {2'000'000'000}};
  log.read = [](std::size_t k) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    return k == 0 ? LidarScan{{{1, 2, 3}, {nan, 0, -1}}, {}} : LidarScan{{{4, 5, 6}}, {-0.25F}};
  };
  return log;
}

TEST(WriteMission, KeepsScansAndInertialReadings) {
  Files files = example_mission();
  files["robots/b/imu.csv"] = kImu;
  Mission mission = read_folder(files);
  mission.robots[0].lidar = two_scans();
  const TemporaryFolder folder;
  write_mission(folder.path(), mission);
  const Mission again = read_mission(folder.path());
  const LidarLog& log = again.robots[0].lidar;
  EXPECT_EQ(log.stamps, mission.robots[0].lidar.stamps);
  EXPECT_EQ(log.read(0).points[0], Eigen::Vector3f(1, 2, 3));
  EXPECT_TRUE(std::isnan(log.read(0).points[1].x()));
  EXPECT_TRUE(log.read(0).times_s.empty());
  EXPECT_EQ(log.read(1).points[0], Eigen::Vector3f(4, 5, 6));
  EXPECT_EQ(log.read(1).times_s, std::vector<float>{-0.25F});
  EXPECT_EQ(folder.read("robots/b/imu.csv"), kImu);
}

TEST(ReadTruth, IsApartAndKnowsWhereOnlyPositionsAreTrue) {
  const TemporaryFolder folder;
  Files files = example_mission();
  write_files(folder, files);
  const Truth truth = read_truth(folder.path(), read_mission(folder.path()));
  ASSERT_EQ(truth.robots.size(), 2u);
  EXPECT_EQ(truth.robots[0].id, "a");
  EXPECT_EQ(truth.robots[0].poses.size(), 2u);
  EXPECT_FALSE(truth.robots[0].has_orientation);
  EXPECT_TRUE(truth.robots[1].has_orientation);
}

TEST(ReadTruth, MayBeMissing) {
  const TemporaryFolder folder;
  Files files = example_mission();
  files.erase("robots/a/groundtruth.tum");
  files.erase("robots/b/groundtruth.tum");
  write_files(folder, files);
  EXPECT_TRUE(read_truth(folder.path(), read_mission(folder.path())).empty());
}

TEST(WriteMission, ReadsBackAsTheSameMission) {
  Mission mission = read_folder(example_mission());
  mission.name = "odd: name \"quoted\" # 1";
  mission.robots[0].id = "1";
  mission.robots[1].id = "null";
  const Files files = written(mission);
  const Mission again = read_folder(files);
  EXPECT_EQ(again.name, mission.name);
  EXPECT_EQ(again.robots[1].id, "null");
  EXPECT_EQ(again.robots[1].odometry_noise.sigma_yaw_per_rad, 0.3);
  EXPECT_EQ(again.robots[1].heading, Heading::kAbsolute);
  EXPECT_NEAR(again.robots[1].initial_pose->yaw(), 0.5, 1e-12);
  EXPECT_EQ(written(again), files);
}

TEST(WriteMission, WritesTheTruthBesideIt) {
  const TemporaryFolder folder;
  write_files(folder, example_mission());
  const Mission mission = read_mission(folder.path());
  const Files files = written(mission, read_truth(folder.path(), mission));
  EXPECT_EQ(files.count("robots/a/groundtruth.tum"), 1u);
  EXPECT_EQ(files.at("robots/b/groundtruth.tum").substr(0, 10), "0 5 0 0 0 ");
}

}  // namespace
}  // namespace radioslam
