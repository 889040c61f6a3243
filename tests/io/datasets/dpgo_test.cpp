// Measurement tables of dpgo: precisions, rows in two tables, and the mission made of them.
#include "radioslam/io/datasets/dpgo.hpp"

#include <gtest/gtest.h>

#include "io/recorded_data.hpp"
#include "io/refusal.hpp"
#include "radioslam/graph/residuals.hpp"

namespace radioslam {
namespace {

const std::string kDpgoHeader =
    "robot_src,pose_src,robot_dst,pose_dst,qx,qy,qz,qw,tx,ty,tz,kappa,tau,is_known_inlier,weight\n";
const std::string kDpgoStep = ",0,0,0,1,2,0,0,10000,100,1,1\n", kDpgoLoop = ",0,0,0.6,0.8,1,2,3,50,4,0,";

TeamGraphFile<SE3> dpgo_graph(const std::vector<std::string>& tables) {
  std::vector<Text> texts;
  for (const std::string& rows : tables) texts.push_back(make_text("m.csv", kDpgoHeader + rows));
  return read_dpgo(texts);
}

/// The loop stands in both tables, with weights that differ in the last digit.
TeamGraphFile<SE3> two_robots() {
  return dpgo_graph({"0,0,0,1" + kDpgoStep + "0,1,1,0" + kDpgoLoop + "0.5\n",
                     "1,0,1,1" + kDpgoStep + "0,1,1,0" + kDpgoLoop + "0.6\n"});
}

TEST(Dpgo, RowsInTwoTablesCountOnce) {
  const auto file = two_robots();
  ASSERT_EQ(file.team.segments.size(), 2u);
  EXPECT_EQ(file.team.segments[1].robot, "b");
  ASSERT_EQ(file.team.graph.relative_poses.size(), 3u);
  EXPECT_EQ(file.team.graph.relative_poses[2].i, PoseId(1));
  EXPECT_EQ(file.pose_ids[2], std::uint64_t{'b'} << 56);
  EXPECT_EQ(dpgo_graph({"0,0,0,1" + kDpgoStep + "0,0,0,1" + kDpgoStep}).team.graph.relative_poses.size(), 2u);
}

/// For small errors the cost is that of SE-Sync, kappa |R_j - R_i R|_F^2 + tau |t_j - t_i - R_i t|^2.
TEST(Dpgo, PrecisionsGiveTheCostOfSeSync) {
  auto graph = two_robots().team.graph;
  const auto& loop = graph.relative_poses[2];
  const SE3::Tangent error = (SE3::Tangent() << 0.01, -0.02, 0.03, 0.001, 0.002, -0.003).finished();
  const SE3 T_i = SE3::exp((SE3::Tangent() << 4, 5, 6, 0.3, -0.4, 0.5).finished());
  const SE3 T_j = T_i * loop.T_i_j * SE3::exp(error);
  graph.poses[1] = T_i;
  graph.poses[2] = T_j;
  const Eigen::Matrix3d turned = T_j.rotation_matrix() - T_i.rotation_matrix() * loop.T_i_j.rotation_matrix();
  const Eigen::Vector3d moved = T_j.translation() - T_i * loop.T_i_j.translation();
  const double cost = 50 * turned.squaredNorm() + 4 * moved.squaredNorm();
  EXPECT_NEAR(squared_norm(graph, loop), cost, 1e-3 * cost);
}

TEST(Dpgo, AMissionHasOdometryAndMatches) {
  const Mission mission = mission_of_team(two_robots(), "tunnels").mission;
  ASSERT_EQ(mission.robots.size(), 2u);
  EXPECT_EQ(mission.robots[0].odometry[1].stamp, Stamp::from_seconds(1));
  EXPECT_EQ(mission.robots[0].odometry[1].pose.translation().x(), 2);
  EXPECT_NEAR(mission.robots[0].odometry_noise.sigma_xy_per_sqrt_m, std::sqrt(1.0 / 100 / 2), 1e-12);
  EXPECT_NEAR(mission.robots[0].odometry_noise.sigma_yaw_per_sqrt_m_rad, std::sqrt(1.0 / 20000 / 2), 1e-12);
  ASSERT_EQ(mission.matches.size(), 1u);
  EXPECT_EQ(mission.matches[0].robot_j, RobotIndex(1));
  EXPECT_EQ(mission.matches[0].stamp_i, Stamp::from_seconds(1));
  EXPECT_NEAR(mission.matches[0].covariance(0, 0), 1.0 / 4, 1e-12);
  EXPECT_NEAR(mission.matches[0].covariance(4, 4), 1.0 / 100, 1e-12);
  expect_refusal([] { mission_of_team(dpgo_graph({"0,0,0,1" + kDpgoStep + "0,2,0,3" + kDpgoStep}), "x"); }, 0,
                 "has a gap");
}

TEST(Dpgo, BadRowsAreLeftOutWithANote) {
  const auto file = dpgo_graph({"0,0,0,1" + kDpgoStep + "0,1,0\n0,1,0,2,0,0,0,0,1,0,0,1,1,1,1\n0,1,0,x" +
                                kDpgoStep + "0,1,99,0" + kDpgoStep + "0,1,0,1" + kDpgoStep +
                                "0,1,0,2,0,0,0,1,1,0,0,-1,1,1,1\n0,1,0,2" + kDpgoStep});
  EXPECT_EQ(file.pose_ids.size(), 3u);
  ASSERT_EQ(file.notes.size(), 1u);
  EXPECT_NE(file.notes[0].find("6 lines are left out; the first: m.csv:3:"), std::string::npos)
      << file.notes[0];
  expect_refusal([] { dpgo_graph({"0,1,0\n"}); }, 2, "");
  expect_refusal([] { dpgo_graph({""}); }, 0, "no rows");
  expect_refusal([] { read_dpgo(std::vector<Text>{make_text("m.csv", "robot_src,pose_src\n")}); }, 1,
                 "'robot_dst' is missing");
}

TEST(Dpgo, ReadsTheTunnels) {
  RADIOSLAM_RECORDED(path, "multirobot_tunnels");
  const auto file = import_dpgo({path});
  EXPECT_EQ(file.pose_ids.size(), 1255u);
  EXPECT_EQ(file.team.segments.size(), 8u);
  EXPECT_EQ(file.team.graph.relative_poses.size(), 4891u);
  EXPECT_TRUE(file.notes.empty());
  EXPECT_EQ(mission_of_team(file, path.string()).mission.matches.size(), 96u + 3548u);
}

}  // namespace
}  // namespace radioslam
