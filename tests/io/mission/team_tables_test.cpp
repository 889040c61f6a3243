// The tables of a team: meaning of their rows, and reading back what was written.
#include "radioslam/io/mission/team_tables.hpp"

#include <cmath>
#include <numbers>

#include "io/example_mission.hpp"
#include "io/refusal.hpp"
#include "radioslam/io/mission/mission_folder.hpp"
#include "radioslam/io/mission/robot_tables.hpp"

namespace radioslam {
namespace {

const RobotIndex kA(0);
const RobotIndex kB(1);

TeamNames names() { return {{{"a", kA}, {"b", kB}}, {{{"front", {0.2, 0, 0.1}}}}, {{"A1", AnchorIndex(0)}}}; }

const std::string kRanges = "t_s,robot_i,robot_j,range_m,sigma_m,antenna_i,antenna_j\n";

std::vector<RangeMeasurement> ranges(const std::string& rows) {
  return read_ranges(make_text("ranges.csv", kRanges + rows), names());
}

TEST(Ranges, AreSortedByTimeThenByRow) {
  const auto read = ranges("2,a,b,1,0.1,,\n1,a,b,2,0.1,,\n2,b,A1,3,0.2,,\n1,A1,a,4,0.1,,\n");
  ASSERT_EQ(read.size(), 4u);
  EXPECT_EQ(read[0].range_m, 2);
  EXPECT_EQ(read[1].range_m, 4);
  EXPECT_EQ(read[2].range_m, 1);
  EXPECT_EQ(read[3].range_m, 3);
  EXPECT_EQ(read[3].sigma_m, 0.2);
  EXPECT_EQ(read[3].i.robot, kB);
  EXPECT_FALSE(read[3].j.robot.valid());
  EXPECT_EQ(read[3].j.anchor, AnchorIndex(0));
}

TEST(Ranges, TakeTheLeverArmOfANamedAntenna) {
  const auto read = ranges("1,a,b,2,0.1,front,\n2,a,b,2,0.1,,\n3,b,a,2,0.1,,front\n");
  EXPECT_EQ(read[0].i.antenna, "front");
  EXPECT_EQ(read[0].i.lever_arm_m, Eigen::Vector3d(0.2, 0, 0.1));
  EXPECT_EQ(read[0].j.lever_arm_m, Eigen::Vector3d::Zero());
  EXPECT_EQ(read[1].i.lever_arm_m, Eigen::Vector3d::Zero());
  EXPECT_EQ(read[2].j.lever_arm_m, Eigen::Vector3d(0.2, 0, 0.1));
}

TEST(Ranges, RefuseWhatTiesNothing) {
  expect_refusal([] { ranges("1,a,b,2,0.1,,\n1,a,b,2,0.1,,front\n"); }, 3, "unknown antenna 'front'");
  expect_refusal([] { ranges("1,a,A1,2,0.1,front,front\n"); }, 2, "only robots have antennas");
  expect_refusal([] { ranges("1,A1,A1,2,0.1,,\n"); }, 2, "neither end is a robot");
  expect_refusal([] { ranges("1,b,b,2,0.1,,\n"); }, 2, "to itself");
}

const std::string kAoa = "t_s,receiver,transmitter,path,azimuth_rad,elevation_rad,sigma_rad,power_db\n";

std::vector<AoaMeasurement> aoa_measurements(const std::string& rows) {
  return read_aoa(make_text("aoa.csv", kAoa + rows), names());
}

TEST(AoaMeasurements, AreGroupedByTimeReceiverAndTransmitter) {
  const auto read = aoa_measurements(
      "2,a,b,1,0.1,0.5,0.2,-3\n1,b,a,0,0.2,,0.2,-3\n2,a,b,0,0.3,,0.2,\n"
      "2,a,A1,0,0.4,,0.2,-3\n2,b,a,0,0.5,,0.2,-3\n");
  ASSERT_EQ(read.size(), 4u);
  EXPECT_EQ(read[0].receiver, kB);
  ASSERT_EQ(read[1].paths.size(), 2u);
  EXPECT_EQ(read[1].paths[0].azimuth_rad, 0.3);
  EXPECT_EQ(read[1].paths[0].power_db, 0);
  EXPECT_FALSE(read[1].paths[0].elevation_rad);
  EXPECT_EQ(read[1].paths[1].azimuth_rad, 0.1);
  EXPECT_EQ(read[1].paths[1].elevation_rad, 0.5);
  EXPECT_EQ(read[1].paths[1].power_db, -3);
  EXPECT_EQ(read[2].transmitter.anchor, AnchorIndex(0));
  EXPECT_EQ(read[3].paths[0].azimuth_rad, 0.5);
}

TEST(AoaMeasurements, WrapTheirAnglesAndRefuseOnlyWhatIsNotFinite) {
  const auto read = aoa_measurements("1,a,b,0,7,-7,0.2,0\n");
  EXPECT_NEAR(read[0].paths[0].azimuth_rad, 7 - 2 * std::numbers::pi, 1e-12);
  EXPECT_NEAR(*read[0].paths[0].elevation_rad, 2 * std::numbers::pi - 7, 1e-12);
  expect_refusal([] { aoa_measurements("1,a,b,0,nan,0,0.2,0\n"); }, 2, "not a finite number");
  expect_refusal([] { aoa_measurements("1,a,b,0,1,inf,0.2,0\n"); }, 2, "not a finite number");
  expect_refusal([] { aoa_measurements("1,a,a,0,1,0,0.2,0\n"); }, 2, "to itself");
}

TEST(Anchors, AreKnownWhereTheirCoordinatesAre) {
  const Text text = make_text("anchors.csv", "id,x_m,y_m,z_m,sigma_m\nA,1,2,3,0.5\nB,,,,\nC,1,2,,\n");
  const auto plane = read_anchors(text, names(), 2);
  ASSERT_EQ(plane.size(), 3u);
  EXPECT_EQ(plane[0].position_m, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(plane[0].sigma_m, 0.5);
  EXPECT_FALSE(plane[1].position_m);
  EXPECT_EQ(plane[2].position_m, Eigen::Vector3d(1, 2, 0));
  EXPECT_FALSE(read_anchors(text, names(), 3)[2].position_m);
}

TEST(Matches, AreRelativePoses) {
  const std::string header = "robot_i,t_i_s,robot_j,t_j_s,x,y,z,qx,qy,qz,qw,sigma_t_m,sigma_r_rad\n";
  const auto read =
      read_matches(make_text("matches.csv", header + "b,2,a,1,1,2,3,0,0,1,0,0.1,0.01\n"), names());
  ASSERT_EQ(read.size(), 1u);
  EXPECT_EQ(read[0].robot_i, kB);
  EXPECT_EQ(read[0].stamp_j, Stamp::from_seconds(1));
  EXPECT_EQ(read[0].T_i_j.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_NEAR(std::abs(read[0].T_i_j.yaw()), std::numbers::pi, 1e-12);
  EXPECT_EQ(read[0].covariance, isotropic_covariance(0.1, 0.01));
  expect_refusal([&] { read_matches(make_text("m", header + "b,2,a,1,1,2,3,0,0,0,0,0.1,0.01\n"), names()); },
                 2, "quaternion is zero");
}

std::string covariance_header() {
  std::string header = "robot_i,t_i_s,robot_j,t_j_s,x,y,z,qx,qy,qz,qw";
  for (const std::string row : {"tx", "ty", "tz", "rx", "ry", "rz"})
    for (const std::string column : {"tx", "ty", "tz", "rx", "ry", "rz"})
      if (header.find("cov_" + column + "_" + row) == std::string::npos)
        header += ",cov_" + row + "_" + column;
  return header + "\n";
}

std::vector<PoseMatch> with_covariance(const std::string& triangle) {
  const std::string row = "a,1,b,2,1,2,3,0,0,0,1," + triangle + "\n";
  return read_matches(make_text("matches.csv", covariance_header() + row), names());
}

TEST(Matches, MayHaveTheirWholeCovariance) {
  const SE3::Jacobian covariance =
      with_covariance("4,0.5,0,0,0,0.25,5,0,0,0,0,6,0,0,0,1,0,0,2,0,3").front().covariance;
  EXPECT_EQ((SE3::Tangent() << 4, 5, 6, 1, 2, 3).finished(), covariance.diagonal());
  EXPECT_EQ(covariance(0, 1), 0.5);
  EXPECT_EQ(covariance(5, 0), 0.25);
  EXPECT_EQ(covariance, covariance.transpose());
}

TEST(Matches, RefuseACovarianceThatIsNotPositiveDefinite) {
  expect_refusal([] { with_covariance("1,0,0,0,0,2,1,0,0,0,0,1,0,0,0,1,0,0,1,0,1"); }, 2,
                 "not positive definite");
  expect_refusal([] { with_covariance("1,0,0,0,0,0,1,0,0,0,0,0,0,0,0,1,0,0,1,0,1"); }, 2,
                 "not positive definite");
  expect_refusal(
      [] { read_matches(make_text("m", "robot_i,t_i_s,robot_j,t_j_s,x,y,z,qx,qy,qz,qw\n"), names()); }, 1,
      "'sigma_t_m' is missing");
  expect_refusal(
      [] {
        read_matches(make_text("m", "robot_i,t_i_s,robot_j,t_j_s,x,y,z,qx,qy,qz,qw,cov_tx_tx\n"), names());
      },
      1, "'cov_tx_ty' is missing");
}

/// With sigmas that square and root do not restore, or with correlations, 21 columns are written.
TEST(Matches, ReadBackBitForBit) {
  Mission mission;
  mission.robots.resize(2);
  mission.robots[0].id = "a";
  mission.robots[1].id = "b";
  PoseMatch match{kA, kB, Stamp{1}, Stamp{2}, SE3(), isotropic_covariance(0.1, 0.3)};
  const auto read_back = [&] { return read_matches(make_text("m", format_matches(mission)), names()); };
  mission.matches = {match};
  EXPECT_NE(format_matches(mission).find("sigma_t_m,sigma_r_rad\n"), std::string::npos);
  EXPECT_EQ(read_back().front().covariance, match.covariance);
  match.covariance(0, 5) = match.covariance(5, 0) = 0.01 / 3;
  mission.matches.push_back(match);
  EXPECT_NE(format_matches(mission).find("cov_tx_tx,cov_tx_ty"), std::string::npos);
  for (std::size_t k = 0; k < 2; ++k) EXPECT_EQ(read_back()[k].covariance, mission.matches[k].covariance);
  mission.matches = {match};
  mission.matches[0].covariance = 0.7 * SE3::Jacobian::Identity();
  mission.matches[0].covariance(0, 0) = std::nextafter(0.7, 1);
  EXPECT_EQ(read_back().front().covariance, mission.matches[0].covariance);
}

TEST(Fixes, AreSortedByTime) {
  const auto read = read_fixes(make_text("gnss.csv", "t_s,x_m,y_m,z_m,sigma_m\n2,1,2,3,4\n1,5,6,7,8\n"));
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0].position_m, Eigen::Vector3d(5, 6, 7));
  EXPECT_EQ(read[1].sigma_m, 4);
}

/// A mission with every table, read from its folder, with labels.
struct LabelledMission {
  Mission mission;
  Truth truth;
};

Files full_mission() {
  Files files = example_mission();
  files["mission.yaml"] =
      "format: radioslam-mission/1\nrobots:\n  a: {antennas: {front: [0.2, 0, 0.1]}}\n"
      "  b: {lidar: {view_deg: 90}}\ndefaults: {antennas: {top: [0, 0, 1]}}\n";
  files["radio/ranges.csv"] = kRanges + "0.5,a,b,3,0.1,front,top\n0.2,a,A1,2,0.1,top,\n";
  files["radio/aoa.csv"] = kAoa + "0.5,a,b,0,1,,0.1,-3\n0.5,a,b,1,2,0.1,0.1,-3\n0.6,b,A2,0,1,,0.1,-3\n";
  files["robots/b/gnss.csv"] = "t_s,x_m,y_m,z_m,sigma_m\n1,2,3,4,5\n";
  files["matches.csv"] += "a,1,b,0,5,2,0,0,0,0,1,0.1,0.01\nb,1,a,0,5,2,0,0,0,0,1,0.1,0.01\n";
  files["radio/direct_paths.csv"] = "t_s,receiver,transmitter,path\n0.6,b,A2,-1\n0.5,a,b,1\n9,a,b,0\n";
  files["match_labels.csv"] = "robot_i,t_i_s,robot_j,t_j_s,label\na,1,b,0,true\na,1,b,0,false\n";
  return files;
}

LabelledMission read_tables(const Files& files) {
  const TemporaryFolder folder;
  write_files(folder, files);
  Mission mission = read_mission(folder.path());
  Truth truth = read_truth(folder.path(), mission);
  return {std::move(mission), std::move(truth)};
}

TEST(MissionWithRadio, HoldsEveryTable) {
  const auto [mission, truth] = read_tables(full_mission());
  ASSERT_EQ(mission.anchors.size(), 2u);
  ASSERT_EQ(mission.ranges.size(), 2u);
  EXPECT_EQ(mission.ranges[0].i.lever_arm_m, Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(mission.ranges[1].j.lever_arm_m, Eigen::Vector3d(0, 0, 1));
  ASSERT_EQ(mission.aoa_measurements.size(), 2u);
  EXPECT_EQ(mission.aoa_measurements[1].transmitter.anchor, AnchorIndex(1));
  EXPECT_EQ(mission.matches.size(), 3u);
  EXPECT_EQ(mission.robots[1].fixes.size(), 1u);
  EXPECT_NEAR(mission.robots[1].lidar_view_rad, std::numbers::pi / 2, 1e-12);
  EXPECT_EQ(mission.robots[0].lidar_view_rad, 2 * std::numbers::pi);
  EXPECT_TRUE(mission.unused_files.empty());
}

TEST(MissionWithRadio, KeepsItsLabelsWithTheTruth) {
  const auto [mission, truth] = read_tables(full_mission());
  using Paths = std::vector<std::optional<int>>;
  using Labels = std::vector<std::optional<bool>>;
  EXPECT_EQ(truth.direct_paths, (Paths{1, kNoDirectPath}));
  EXPECT_EQ(truth.true_matches, (Labels{true, false, std::nullopt}));
}

TEST(MissionWithRadio, ReadsBackAsItWasWritten) {
  const auto [mission, truth] = read_tables(full_mission());
  const TemporaryFolder first, second;
  write_mission(first.path(), mission, truth);
  const Mission again = read_mission(first.path());
  EXPECT_EQ(again.ranges[1].i.antenna, "front");
  EXPECT_EQ(again.ranges[1].i.lever_arm_m, mission.ranges[1].i.lever_arm_m);
  EXPECT_NEAR(again.robots[1].lidar_view_rad, mission.robots[1].lidar_view_rad, 1e-12);
  EXPECT_FALSE(again.anchors[1].position_m);
  write_mission(second.path(), again, read_truth(first.path(), again));
  for (const char* name : {"mission.yaml", "radio/anchors.csv", "radio/ranges.csv", "radio/aoa.csv",
                           "radio/direct_paths.csv", "matches.csv", "match_labels.csv", "robots/b/gnss.csv"})
    EXPECT_EQ(first.read(name), second.read(name)) << name;
}

TEST(MissionWithRadio, NamesWhatNobodyUses) {
  Files files = example_mission();
  files["robots/a/imu.csv"] = "t_s,ax_mps2,ay_mps2,az_mps2,wx_radps,wy_radps,wz_radps\n2,0,0,9.8,0,0,0\n";
  files["robots/b/csi/1.dat"] = "anything";
  EXPECT_EQ(read_tables(files).mission.unused_files, std::vector<std::string>{"robots/b/csi"});
}

}  // namespace
}  // namespace radioslam
