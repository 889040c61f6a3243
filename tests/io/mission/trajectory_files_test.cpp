#include "io/recorded_data.hpp"
#include "io/refusal.hpp"
#include "radioslam/io/lidar/kitti_sequence.hpp"
#include "radioslam/io/mission/tum.hpp"

namespace radioslam {
namespace {

Trajectory<SE3> tum(const std::string& content) { return read_tum(make_text("o.tum", content)); }
void expect_tum_refused(const std::string& content, std::size_t line, const std::string& words) {
  expect_refusal([&] { tum(content); }, line, words);
}

TEST(ReadTum, TakesStampsExactlyAndNormalises) {
  const auto trajectory =
      tum("# t x y z\n1574407123.123456789 1 2 3 0 0 0.606 0.808\n1574407124 4 5 6 0 0 0 1");
  ASSERT_EQ(trajectory.size(), 2u);
  EXPECT_EQ(trajectory[0].stamp.ns, 1574407123123456789);
  EXPECT_EQ(trajectory[0].pose.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_NEAR(trajectory[0].pose.rotation().z(), 0.6, 1e-15);
  EXPECT_NEAR(trajectory[0].pose.rotation().w(), 0.8, 1e-15);
}

TEST(ReadTum, ReadsBackWhatItWrites) {
  const auto trajectory = tum("0.000000001 0.1 -2e-7 3 0 0 0.6 0.8\n12.5 1 2 3 0.5 0.5 0.5 0.5\n");
  const std::string written = format_tum(trajectory);
  EXPECT_EQ(format_tum(tum(written)), written);
  EXPECT_EQ(written.substr(0, written.find(' ')), "0.000000001");
  EXPECT_NE(written.find("\n12.5 1 2 3 0.5 0.5 0.5 0.5\n"), std::string::npos);
}

TEST(ReadTum, RefusesTimeThatDoesNotRunForward) {
  const std::string pose = " 0 0 0 0 0 0 1\n";
  expect_tum_refused("1" + pose + "2" + pose + "1.5" + pose, 3, "backwards, from 2 to 1.5");
  expect_tum_refused("# c\n1" + pose + "1.0" + pose, 3, "the time 1 appears twice");
}

TEST(ReadLoggedTum, SortsLateRowsAndLeavesOutBadOnes) {
  const std::string pose = " 0 0 0 0 0 0 1\n";
  std::string log = "not a row\n";
  for (int k = 0; k < 20; ++k) log += std::to_string(k) + ".1" + pose;
  log += "19.05" + pose + "3.5" + pose;
  std::vector<std::string> warnings;
  const auto trajectory = read_logged_tum(make_tool_output("wheels.tum", log), warnings);
  ASSERT_EQ(trajectory.size(), 21U);
  EXPECT_EQ(trajectory[19].stamp.ns, 19'050'000'000);
  ASSERT_EQ(warnings.size(), 3U);
  EXPECT_NE(warnings[0].find("wheels.tum: 1 row is left out; the first: wheels.tum:1:"), std::string::npos);
  EXPECT_NE(warnings[1].find("the first: wheels.tum:23: the time does not increase"), std::string::npos);
  EXPECT_NE(warnings[2].find("1 rows are earlier than the one before them and were sorted"),
            std::string::npos);
}

TEST(ReadLoggedTum, RefusesALogWithoutAUsableClockOrWithoutPoses) {
  const std::string pose = " 0 0 0 0 0 0 1\n";
  std::vector<std::string> warnings;
  const auto read = [&](const std::string& log) {
    read_logged_tum(make_tool_output("w.tum", log), warnings);
  };
  expect_refusal([&] { read("1" + pose + "2" + pose + "9" + pose + "1" + pose + "3" + pose); }, 3,
                 "the time does not increase");
  expect_refusal([&] { read("# nothing\n"); }, 1, "no poses");
  expect_refusal([&] { read("x y\n1" + pose + "a b\n"); }, 1, "t 'x'");
}

TEST(ReadTum, RefusesOrientationsFarFromUnitLength) {
  EXPECT_EQ(tum("1 0 0 0 0 0 0 1.019\n2 0 0 0 0 0 0 -0.981\n").size(), 2u);
  expect_tum_refused("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1.021\n", 2, "norm is 1.021 instead of 1");
  expect_tum_refused("1 0 0 0 0 0 0 0.979\n", 1, "norm is 0.979");
  expect_tum_refused("1 0 0 0 0 0 3 4\n", 1, "norm is 5");
}

TEST(ReadTum, RefusesMalformedRows) {
  const std::string good = "1 0 0 0 0 0 0 1\n";
  expect_tum_refused(good + "2 0 0 0 0 0 0\n", 2, "before qw");
  expect_tum_refused(good + "2 0 0 0 0 0", 2, "the file ends in this line");
  expect_tum_refused(good + "2 0 0 0 0 0 0 0.", 2, "zero");
  expect_tum_refused(good + "2 0 0 0 0 0 0.6 0.7", 2, "the line is truncated");
  expect_tum_refused(good + "2 0 0 0 0 0 0 1 9\n", 2, "too many");
  expect_tum_refused(good + "2 0 nan 0 0 0 0 1\n", 2, "y 'nan'");
  expect_tum_refused(good + "2 0 0 1e9 0 0 0 1\n", 2, "z '1e9' is not a plausible coordinate");
  expect_tum_refused(good + "2 0 0 0 0 0 0 0\n", 2, "the quaternion is zero");
  expect_tum_refused(good + "2,0,0,0,0,0,0,1\n", 2, "is not a time");
  expect_tum_refused("1574407123123456789 0 0 0 0 0 0 1\n", 1, "is not a time in seconds");
  expect_tum_refused("# only a comment\n", 1, "no poses");
}

TEST(ReadKittiPoses, TakesTenPosesPerSecond) {
  const auto trajectory =
      read_kitti_poses(make_text("00.txt", "1 0 0 1 0 1 0 2 0 0 1 3\n0 -1 0 4 1 0 0 5 0 0 1 6\n"));
  ASSERT_EQ(trajectory.size(), 2u);
  EXPECT_EQ(trajectory[1].stamp.ns, 100'000'000);
  EXPECT_EQ(trajectory[1].pose.translation(), Eigen::Vector3d(4, 5, 6));
  EXPECT_NEAR(trajectory[1].pose.yaw(), M_PI / 2, 1e-12);
}

TEST(ReadKittiPoses, RefusesWhatIsNoPose) {
  const auto refused = [](const std::string& content, std::size_t line, const std::string& words) {
    expect_refusal([&] { read_kitti_poses(make_text("00.txt", content)); }, line, words);
  };
  const std::string good = "1 0 0 1 0 1 0 2 0 0 1 3\n";
  refused(good + "1 0 0 1 0 1 0 2 0 0 1\n", 2, "the line ends before");
  refused(good + "1 0 0 1 0 1 0 2 0 0 1 3 4\n", 2, "too many");
  refused(good + "1 0 0 1 0 1 0 2 0 0 -1 3\n", 2, "not a rotation matrix");
  refused(good + "2 0 0 1 0 1 0 2 0 0 1 3\n", 2, "not a rotation matrix");
  refused(good + "1 0 0 1 0 1 0 -1e9 0 0 1 3\n", 2, "plausible");
  refused(good + "1 0 0 1 0 inf 0 1 0 0 1 3\n", 2, "finite");
}

TEST(ReadKittiPoses, TakesAPublishedTrajectory) {
  RADIOSLAM_RECORDED(path, "kitti/aloam_lidar/00.txt");
  EXPECT_EQ(read_kitti_poses(read_text(path)).size(), 4541u);
}

}  // namespace
}  // namespace radioslam
