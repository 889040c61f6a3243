// A team's graph in PyFG: meaning of the lines, trajectory segments, and all errors.
#include "radioslam/io/graph/pyfg.hpp"

#include "io/refusal.hpp"

namespace radioslam {
namespace {

const std::string kTwoRobots =
    "VERTEX_SE2 0.5 A0 1 2 0.1\nVERTEX_SE2 1.5 A1 2 2 0.2\nVERTEX_SE2 2.5 A2 3 2 0.2\n"
    "VERTEX_SE2 0.5 B7 5 2 3\nVERTEX_SE2 0.5 B8 6 2 3\nVERTEX_XY L0 3 3\nVERTEX_XY L1 4 4\n";
const std::string kCovariance = " 0.04 0 0 0.04 0 0.01\n";
const std::string kOdometry = "EDGE_SE2 1.5 A0 A1 1 0 0.5" + kCovariance + "EDGE_SE2 2.5 A1 A2 2 0 0" +
                              kCovariance + "EDGE_SE2 9 B7 B8 3 0 0" + kCovariance;

TeamGraphFile<SE2> read_pyfg(const std::string& content, StatedStarts starts = StatedStarts::kIgnored) {
  return std::get<TeamGraphFile<SE2>>(read_pyfg(make_text("t.pyfg", content), starts));
}

TEST(Pyfg, EachRobotIsAPieceReckonedFromTheIdentity) {
  const auto file = read_pyfg(kTwoRobots + kOdometry);
  ASSERT_EQ(file.team.segments.size(), 2u);
  const TrajectorySegment& a = file.team.segments[0];
  const TrajectorySegment& b = file.team.segments[1];
  EXPECT_EQ(a.robot, "A");
  EXPECT_EQ(a.pose_count, 3u);
  EXPECT_EQ(b.robot, "B");
  EXPECT_EQ(b.first_pose, 3u);
  EXPECT_EQ(b.pose_count, 2u);
  EXPECT_FALSE(a.in_common_frame);
  const auto& poses = file.team.graph.poses;
  EXPECT_LT(poses[0].log().norm(), 1e-12);
  EXPECT_LT((poses[2].inverse() * SE2({1 + 2 * std::cos(0.5), 2 * std::sin(0.5)}, 0.5)).log().norm(), 1e-12);
  EXPECT_LT(poses[3].log().norm(), 1e-12);
  EXPECT_EQ(file.pose_names, (std::vector<std::string>{"A0", "A1", "A2", "B7", "B8"}));
}

TEST(Pyfg, VertexLinesAreTheTruthAndTheStamps) {
  const auto file = read_pyfg(kTwoRobots + kOdometry);
  EXPECT_EQ(file.true_poses[1]->translation(), Eigen::Vector2d(2, 2));
  EXPECT_EQ(file.true_points[1], Eigen::Vector2d(4, 4));
  EXPECT_EQ(file.team.graph.points[1], Eigen::Vector2d::Zero());
  EXPECT_EQ(file.team.segments[0].stamps[1], Stamp::from_seconds(1.5));
}

TEST(Pyfg, EqualStampsAreSeparated) {
  const auto file = read_pyfg(kTwoRobots + kOdometry);
  const auto& stamps = file.team.segments[1].stamps;
  EXPECT_EQ(stamps[1].ns, stamps[0].ns + 1);
}

TEST(Pyfg, CovariancesBecomeInformation) {
  const auto file = read_pyfg(kTwoRobots + "EDGE_SE2 0 A0 A1 1 0 0 0.04 0.01 0 0.04 0.002 0.01\n");
  Eigen::Matrix3d covariance;
  covariance << 0.04, 0.01, 0, 0.01, 0.04, 0.002, 0, 0.002, 0.01;
  EXPECT_LT((file.team.graph.relative_poses[0].information * covariance - Eigen::Matrix3d::Identity()).norm(),
            1e-9);
}

TEST(Pyfg, MissingOdometryBeginsANewPiece) {
  const auto file = read_pyfg(kTwoRobots + "EDGE_SE2 1 A1 A2 1 0 0" + kCovariance);
  ASSERT_EQ(file.team.segments.size(), 4u);
  EXPECT_EQ(file.team.segments[0].pose_count, 1u);
  EXPECT_EQ(file.team.segments[1].robot, "A");
  EXPECT_EQ(file.team.segments[1].first_pose, 1u);
  EXPECT_EQ(file.team.segments[1].pose_count, 2u);
  EXPECT_LT(file.team.graph.poses[1].log().norm(), 1e-12);
}

TEST(Pyfg, OtherEdgesBetweenPosesFollowTheOdometry) {
  const auto file = read_pyfg("EDGE_SE2 1 A0 A2 9 0 0" + kCovariance + "EDGE_SE2 1 B7 A0 8 0 0" +
                              kCovariance + kTwoRobots + kOdometry + "EDGE_SE2 1 A0 A1 7 0 0" + kCovariance);
  const auto& factors = file.team.graph.relative_poses;
  ASSERT_EQ(factors.size(), 6u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(factors[k].j.value, factors[k].i.value + 1);
  EXPECT_EQ(factors[3].T_i_j.translation().x(), 9);
  EXPECT_EQ(factors[4].T_i_j.translation().x(), 8);
  EXPECT_EQ(factors[4].i, PoseId(3));
  EXPECT_EQ(factors[5].T_i_j.translation().x(), 7);  // the second edge between neighbours
}

TEST(Pyfg, OdometryBackwardsIsTurnedRound) {
  const auto forward = read_pyfg(kTwoRobots + "EDGE_SE2 1 A0 A1 1 2 0.5" + kCovariance);
  const SE2 back = SE2({1, 2}, 0.5).inverse();
  const auto backward = read_pyfg(kTwoRobots + "EDGE_SE2 1 A1 A0 " + std::to_string(back.translation().x()) +
                                  " " + std::to_string(back.translation().y()) + " -0.5" + kCovariance);
  const auto& factor = backward.team.graph.relative_poses[0];
  EXPECT_EQ(factor.i, PoseId(0));
  EXPECT_EQ(factor.j, PoseId(1));
  EXPECT_LT((factor.T_i_j.inverse() * SE2({1, 2}, 0.5)).log().norm(), 1e-5);
  // Z Exp(xi) = (Z^-1 Exp(-Ad(Z) xi))^-1, so the cost is the same in both directions.
  const SE2::Tangent xi(0.01, -0.02, 0.005);
  const SE2 moved = back * SE2::exp(xi);
  const SE2::Tangent error = (factor.T_i_j.inverse() * moved.inverse()).log();
  const Eigen::Vector3d variances(0.04, 0.04, 0.01);
  EXPECT_NEAR(error.dot(factor.information * error), xi.dot(xi.cwiseQuotient(variances)), 1e-5);
  EXPECT_LT((backward.team.graph.poses[1].inverse() * forward.team.graph.poses[1]).log().norm(), 1e-5);
}

TEST(Pyfg, RangesAndSightingsReachPosesAndPoints) {
  const auto file = read_pyfg(kTwoRobots + kOdometry +
                              "EDGE_RANGE 1 A1 B8 4 0.04\nEDGE_RANGE 1 A1 L1 5 0.09\n"
                              "EDGE_SE2_XY 1 B7 L0 2 1 0.25 0 0.16\n");
  const auto& graph = file.team.graph;
  ASSERT_EQ(graph.ranges.size(), 2u);
  EXPECT_EQ(graph.ranges[0].j.pose, PoseId(4));
  EXPECT_EQ(graph.ranges[0].sigma_m, 0.2);
  EXPECT_EQ(graph.ranges[1].j.point, PointId(1));
  EXPECT_FALSE(graph.ranges[1].j.pose.valid());
  ASSERT_EQ(graph.relative_points.size(), 1u);
  EXPECT_EQ(graph.relative_points[0].i, PoseId(3));
  EXPECT_EQ(graph.relative_points[0].position, Eigen::Vector2d(2, 1));
  EXPECT_NEAR(graph.relative_points[0].information(1, 1), 1 / 0.16, 1e-12);
}

TEST(Pyfg, APriorPutsAPieceIntoTheCommonFrame) {
  const auto file = read_pyfg(kTwoRobots + kOdometry + "VERTEX_SE2:PRIOR 0 A1 10 20 1" + kCovariance +
                              "VERTEX_XY:PRIOR 0 L1 4 5 1 0 1\n");
  EXPECT_TRUE(file.team.segments[0].in_common_frame);
  EXPECT_FALSE(file.team.segments[1].in_common_frame);
  const auto& poses = file.team.graph.poses;
  EXPECT_LT((poses[1].inverse() * SE2({10, 20}, 1)).log().norm(), 1e-12);
  EXPECT_LT((poses[0].inverse() * poses[1] * SE2({1, 0}, 0.5).inverse()).log().norm(), 1e-12);
  EXPECT_EQ(file.team.graph.pose_priors[0].i, PoseId(1));
  EXPECT_EQ(file.team.graph.points[1], Eigen::Vector2d(4, 5));
}

TEST(Pyfg, PriorsOnSeveralRobotsPlaceThemOnRequestOnly) {
  const std::string content = kTwoRobots + kOdometry + "VERTEX_SE2:PRIOR 0 A1 10 20 1" + kCovariance +
                              "VERTEX_SE2:PRIOR 0 B7 5 6 0" + kCovariance;
  const auto unknown = read_pyfg(content);
  for (const TrajectorySegment& segment : unknown.team.segments) EXPECT_FALSE(segment.in_common_frame);
  EXPECT_TRUE(unknown.team.graph.pose_priors.empty());
  EXPECT_LT(unknown.team.graph.poses[3].log().norm(), 1e-12);
  ASSERT_EQ(unknown.notes.size(), 1u);
  EXPECT_NE(unknown.notes[0].find("2 robots"), std::string::npos);
  const auto known = read_pyfg(content, StatedStarts::kUsed);
  for (const TrajectorySegment& segment : known.team.segments) EXPECT_TRUE(segment.in_common_frame);
  EXPECT_EQ(known.team.graph.pose_priors.size(), 2u);
  EXPECT_LT((known.team.graph.poses[3].inverse() * SE2({5, 6}, 0)).log().norm(), 1e-12);
  EXPECT_TRUE(known.notes.empty());
}

TEST(Pyfg, ReadsSpace) {
  const auto file = std::get<TeamGraphFile<SE3>>(read_pyfg(make_text(
      "t.pyfg",
      "VERTEX_SE3:QUAT 0 A0 1 2 3 0 0 0 1\nVERTEX_SE3:QUAT 1 A1 2 2 3 0 0 0.6 0.8\nVERTEX_XYZ L0 3 3 1\n"
      "EDGE_SE3:QUAT 1 A0 A1 1 2 3 0 0 0 1 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 4 0 0 4 0 4\n"
      "EDGE_SE3_XYZ 1 A1 L0 1 1 1 1 0 0 1 0 4\nEDGE_RANGE 1 A1 L0 2 0.25\n")));
  EXPECT_EQ(file.team.graph.poses[1].translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_NEAR(file.team.graph.relative_poses[0].information(5, 5), 0.25, 1e-12);
  EXPECT_NEAR(file.team.graph.relative_points[0].information(2, 2), 0.25, 1e-12);
  EXPECT_EQ(file.true_points[0], Eigen::Vector3d(3, 3, 1));
}

struct BadLine {
  const char* name;
  std::string line;
  const char* words;
};

class MalformedPyfg : public testing::TestWithParam<BadLine> {};

TEST_P(MalformedPyfg, IsRefusedWithItsLine) {
  expect_refusal([] { read_pyfg(kTwoRobots + GetParam().line + "\n"); }, 8, GetParam().words);
}

INSTANTIATE_TEST_SUITE_P(
    Pyfg, MalformedPyfg,
    testing::Values(BadLine{"UnknownTag", "EDGE_SE9 1 A0 A1", "unknown tag 'EDGE_SE9'"},
                    BadLine{"MixedDimensions", "VERTEX_XYZ L2 1 2 3", "mixes 2D and 3D"},
                    BadLine{"UnknownVertex", "EDGE_RANGE 1 A0 A9 1 1", "'A9' has no VERTEX line"},
                    BadLine{"PointAsPose", "EDGE_SE2 1 A0 L0 1 0 0" + kCovariance, "not a pose"},
                    BadLine{"ToItself", "EDGE_RANGE 1 A0 A0 1 1", "to itself"},
                    BadLine{"EdgeToItself", "EDGE_SE2 1 A0 A0 1 0 0" + kCovariance, "to itself"},
                    BadLine{"Twice", "VERTEX_SE2 3 A1 0 0 0", "appears twice"},
                    BadLine{"SamePlace", "VERTEX_SE2 3 A01 0 0 0", "another name"},
                    BadLine{"NoNumber", "VERTEX_SE2 3 Ab 0 0 0", "letters and a number"},
                    BadLine{"NoLetter", "VERTEX_SE2 3 17 0 0 0", "letters and a number"},
                    BadLine{"Backwards", "VERTEX_SE2 0.2 A3 0 0 0", "backwards"},
                    BadLine{"FarTime", "VERTEX_SE2 9.1e9 A3 0 0 0", "not plausible"},
                    BadLine{"Variance", "EDGE_RANGE 1 A0 A1 1 0", "not positive"},
                    BadLine{"NegativeRange", "EDGE_RANGE 1 A0 A1 -1 1", "negative"},
                    BadLine{"Covariance", "EDGE_SE2 1 A0 A1 1 0 0 1 2 0 1 0 1", "not positive definite"},
                    BadLine{"ZeroCovariance", "EDGE_SE2_XY 1 A0 L0 1 0 0 0 0", "not positive definite"},
                    BadLine{"Short", "EDGE_SE2 1 A0 A1 1 0 0 1 0 0 1 0", "ends before"},
                    BadLine{"Long", "EDGE_RANGE 1 A0 A1 1 1 1", "too many"},
                    BadLine{"Nan", "EDGE_RANGE 1 A0 A1 nan 1", "not a finite number"}),
    [](const auto& instance) { return instance.param.name; });

TEST(Pyfg, RefusesAGraphWithoutPoses) {
  expect_refusal([] { read_pyfg("VERTEX_XY L0 1 2\n"); }, 1, "no poses");
  expect_refusal([] { read_pyfg("# nothing\n"); }, 1, "no poses");
}

}  // namespace
}  // namespace radioslam
