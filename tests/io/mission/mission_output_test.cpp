// A mission that grows: what is there stays, and nothing is replaced unless asked.
#include "radioslam/io/mission/mission_output.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "io/refusal.hpp"
#include "io/temporary_folder.hpp"
#include "radioslam/io/mission/mission_folder.hpp"
#include "radioslam/io/mission/mission_yaml.hpp"
#include "radioslam/io/text/yaml_insertion.hpp"

namespace radioslam {
namespace {

namespace fs = std::filesystem;

const std::string kYaml =
    "# our floor\n"
    "format: radioslam-mission/1\n"
    "name: floor\n"
    "robots:\n"
    "  a: {initial_pose: [1, 2, 0, 0]}  # by the door\n"
    "defaults:\n"
    "  odometry: {sigma_xy_per_sqrt_m: 0.05}\n";

Mission mission_of(const std::string& id, double sigma_xy = 0.02) {
  Mission mission;
  mission.name = "other";
  Robot& robot = mission.robots.emplace_back();
  robot.id = id;
  robot.odometry = Trajectory<SE3>(
      {{Stamp{0}, SE3()}, {Stamp{1'000'000'000}, SE3({1, 0, 0}, Eigen::Quaterniond::Identity())}});
  robot.odometry_noise.sigma_xy_per_sqrt_m = sigma_xy;
  return mission;
}

struct GrowingMission : testing::Test {
  void SetUp() override {
    folder.write("m/mission.yaml", kYaml);
    folder.write("m/robots/a/odometry.tum", "0 0 0 0 0 0 0 1\n5 2 0 0 0 0 0 1\n");
    folder.write("m/robots/a/imu.csv", "t_s,ax_mps2,ay_mps2,az_mps2,wx_radps,wy_radps,wz_radps\n");
    folder.write("m/robots/a/wifi.csv", "t_s,bssid,frequency_mhz,rssi_dbm\n");
  }
  std::string read(const std::string& name) const { return read_bytes(folder.path() / name); }
  fs::path m() const { return folder.path() / "m"; }
  void import(const Mission& mission,
              MissionOutput::Existing existing = MissionOutput::Existing::kKeep) const {
    MissionOutput(m(), existing).commit(mission);
  }
  std::size_t entries() const {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : fs::recursive_directory_iterator(folder.path())) ++count;
    return count;
  }

  TemporaryFolder folder;
};

TEST_F(GrowingMission, AnotherRobotIsAddedAndEverythingElseStays) {
  import(mission_of("b"));
  std::string expected = kYaml;
  expected.insert(expected.find("defaults:"), "  b: {}\n");
  EXPECT_EQ(read("m/mission.yaml"), expected);
  EXPECT_EQ(read("m/robots/a/odometry.tum"), "0 0 0 0 0 0 0 1\n5 2 0 0 0 0 0 1\n");
  const Mission mission = read_mission(m());
  ASSERT_EQ(mission.robots.size(), 2U);
  EXPECT_EQ(mission.robots[1].odometry.size(), 2U);
  EXPECT_EQ(mission.robots[1].odometry_noise.sigma_xy_per_sqrt_m, 0.05) << "the mission's own default";
}

TEST_F(GrowingMission, ARobotThatTakesTheNoiseOfTheDefaultsIsNoted) {
  MissionOutput output(m(), MissionOutput::Existing::kKeep);
  output.commit(mission_of("b"));
  ASSERT_EQ(output.notes().size(), 1U);
  EXPECT_EQ(output.notes()[0], "robot 'b' takes the odometry noise of the defaults in mission.yaml");
}

TEST_F(GrowingMission, ARobotBringsTheSettingsThatItsImporterKnows) {
  import(mission_of("b", 0.3));
  const Mission mission = read_mission(m());
  EXPECT_EQ(mission.robots[1].odometry_noise.sigma_xy_per_sqrt_m, 0.3);
  EXPECT_EQ(mission.robots[0].odometry_noise.sigma_xy_per_sqrt_m, 0.05);
}

TEST_F(GrowingMission, ATakenNameIsRefusedAndNothingIsWritten) {
  const std::size_t before = entries();
  expect_refusal([&] { import(mission_of("a")); }, 0, "robot 'a' has odometry.tum in this mission already");
  expect_refusal([&] { MissionOutput(m(), MissionOutput::Existing::kKeep).expect_free("a", false); }, 0,
                 "robot 'a' is in this mission already");
  expect_refusal([&] { MissionOutput(m(), MissionOutput::Existing::kKeep).expect_free("a", true); }, 0,
                 "--replace replaces");
  EXPECT_EQ(entries(), before);
  EXPECT_EQ(read("m/mission.yaml"), kYaml);
}

TEST_F(GrowingMission, OnRequestAKindOfRecordingIsReplacedAsAWhole) {
  import(mission_of("a"), MissionOutput::Existing::kReplace);
  EXPECT_EQ(read("m/robots/a/odometry.tum"), "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n");
  EXPECT_FALSE(fs::exists(m() / "robots/a/imu.csv")) << "belonged to the other recording";
  EXPECT_TRUE(fs::exists(m() / "robots/a/wifi.csv"));
  EXPECT_EQ(read("m/mission.yaml"), kYaml);
}

TEST_F(GrowingMission, ARobotGetsWhatItLacks) {
  fs::remove(m() / "robots/a/odometry.tum");
  fs::remove(m() / "robots/a/imu.csv");
  import(mission_of("a", 0.3));
  EXPECT_TRUE(fs::exists(m() / "robots/a/wifi.csv"));
  const Mission mission = read_mission(m());
  EXPECT_EQ(mission.robots[0].odometry_noise.sigma_xy_per_sqrt_m, 0.3);
  EXPECT_TRUE(mission.robots[0].initial_pose);
}

TEST_F(GrowingMission, TheTeamsTablesAreNotReplaced) {
  folder.write("m/radio/anchors.csv", "id,x_m,y_m,z_m,sigma_m\n");
  Mission mission = mission_of("b");
  mission.anchors.push_back({"door", std::nullopt, 0});
  const std::size_t before = entries();
  expect_refusal([&] { import(mission); }, 0, "--replace replaces it");
  EXPECT_EQ(entries(), before);
}

TEST_F(GrowingMission, PositionFixesOfAnotherOriginAreRefused) {
  folder.write("m/robots/a/gnss.csv", "t_s,x_m,y_m,z_m,sigma_m\n1,0,0,0,1\n");
  Mission mission = mission_of("b");
  mission.robots[0].fixes.push_back({Stamp{0}, Eigen::Vector3d::Zero(), 1});
  const std::size_t before = entries();
  expect_refusal([&] { import(mission); }, 0, "has another origin than the position fixes of this import");
  EXPECT_EQ(entries(), before);
}

TEST(YamlInsertion, KeepsTheStyleOfTheMapAndAllOtherBytes) {
  const auto with = [](const std::string& content, const std::vector<std::string>& path) {
    return with_yaml_entry(Text{"mission.yaml", content}, path, "new", "{x: 1}");
  };
  EXPECT_EQ(with("robots: {a: {b: \"}\"}}  # two\nname: x\n", {"robots"}),
            "robots: {a: {b: \"}\"}, new: {x: 1}}  # two\nname: x\n");
  EXPECT_EQ(with("robots: {}\n", {"robots"}), "robots: {new: {x: 1}}\n");
  EXPECT_EQ(with("robots:\n    a:\n      k: 1\n\n# end\nname: x\n", {"robots"}),
            "robots:\n    a:\n      k: 1\n    new: {x: 1}\n\n# end\nname: x\n");
  EXPECT_EQ(with("robots:\n  a:\n    k: 1\n  b: {}", {"robots", "a"}),
            "robots:\n  a:\n    k: 1\n    new: {x: 1}\n  b: {}");
  EXPECT_EQ(with("robots:\n  a:\n  b: {}\n", {"robots", "a"}), "robots:\n  a: {new: {x: 1}}\n  b: {}\n");
  EXPECT_EQ(with("robots:\r\n  a: {}\r\n", {"robots"}), "robots:\r\n  a: {}\r\n  new: {x: 1}\n");
  expect_refusal([&] { with("robots: [a]\n", {"robots"}); }, 0, "has no map 'robots'");
  expect_refusal([&] { with("robots: {a\n", {"robots"}); }, 2, "not valid YAML");
}

TEST(ExtendedMissionYaml, RefusesATextInWhichARobotCannotBeAdded) {
  const Text yaml{"mission.yaml", "format: radioslam-mission/1\nrobots: {a: {},}\n"};
  std::vector<std::string> notes;
  expect_refusal([&] { extended_mission_yaml(yaml, mission_of("b"), notes); }, 2, "under 'robots'");
}

}  // namespace
}  // namespace radioslam
