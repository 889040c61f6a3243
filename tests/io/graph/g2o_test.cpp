#include "radioslam/io/graph/g2o.hpp"

#include <cmath>

#include "io/refusal.hpp"

namespace radioslam {
namespace {

const std::string kIdentity3 = " 1 0 0 1 0 1";
const std::string kIdentity6 = " 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1";

AnyG2oGraph read(const std::string& content, RepairInformation repair = RepairInformation::kNo) {
  return read_g2o(make_text("g.g2o", content), repair);
}
G2oGraph<SE2> read2(const std::string& content, RepairInformation repair = RepairInformation::kNo) {
  return std::get<G2oGraph<SE2>>(read(content, repair));
}
G2oGraph<SE3> read3(const std::string& content) { return std::get<G2oGraph<SE3>>(read(content)); }

void expect_refused(const std::string& content, std::size_t line, const std::string& words) {
  expect_refusal([&] { read(content); }, line, words);
}

TEST(ReadG2o, TakesAPlanarGraph) {
  const auto file = read2(
      "# a comment\n"
      "VERTEX_SE2 7 1 2 0.5\n"
      "\n"
      "VERTEX_SE2 3 4 5 7\n"
      "FIX 3\n"
      "EDGE_SE2 7 3 0.1 0.2 0.3 11 12 13 22 23 333\n");
  EXPECT_EQ(file.graph.chart, PoseChart::kG2o);
  EXPECT_EQ(file.pose_ids, (std::vector<std::uint64_t>{7, 3}));
  EXPECT_EQ(file.pose_has_value, (std::vector<bool>{true, true}));
  EXPECT_EQ(file.graph.pose_fixed, (std::vector<bool>{false, true}));
  EXPECT_NEAR(file.graph.poses[1].angle(), 7 - 2 * M_PI, 1e-12);
  ASSERT_EQ(file.graph.relative_poses.size(), 1u);
  const auto& edge = file.graph.relative_poses[0];
  EXPECT_EQ(edge.i, PoseId(0));
  EXPECT_EQ(edge.j, PoseId(1));
  EXPECT_EQ(edge.T_i_j.translation(), Eigen::Vector2d(0.1, 0.2));
  EXPECT_EQ(edge.T_i_j.angle(), 0.3);
  EXPECT_EQ(edge.information, (Eigen::Matrix3d() << 11, 12, 13, 12, 22, 23, 13, 23, 333).finished());
}

TEST(ReadG2o, TakesAGraphInSpaceAndNormalisesQuaternions) {
  const auto file = read3(
      "VERTEX_SE3:QUAT 0 1 2 3 0 0 2 2\nVERTEX_SE3:QUAT 1 1 2 3 0 0 0 1\n"
      "EDGE_SE3:QUAT 0 1 1 2 3 0.5 0 0 0.5" +
      kIdentity6 + "\n");
  const double half = std::sqrt(0.5);
  EXPECT_NEAR(file.graph.poses[0].rotation().z(), half, 1e-15);
  EXPECT_NEAR(file.graph.poses[0].rotation().w(), half, 1e-15);
  EXPECT_NEAR(file.graph.relative_poses[0].T_i_j.rotation().x(), half, 1e-15);
}

TEST(ReadG2o, TakesPosesOfOtherRobotsWithoutVertexLines) {
  const std::uint64_t a = std::uint64_t{'a'} << 56, b = std::uint64_t{'b'} << 56;
  const auto edge = [](std::uint64_t i, std::uint64_t j) {
    return "EDGE_SE2 " + std::to_string(i) + " " + std::to_string(j) + " 1 0 0" + kIdentity3 + "\n";
  };
  const std::string vertex = "VERTEX_SE2 " + std::to_string(a) + " 0 0 0\n";
  const auto file = read2(vertex + edge(a, b) + edge(a, b + 1));
  EXPECT_EQ(file.pose_ids, (std::vector<std::uint64_t>{a, b, b + 1}));
  EXPECT_EQ(file.pose_has_value, (std::vector<bool>{true, false, false}));
  expect_refused(vertex + edge(a, b) + edge(a, a + 1), 3,
                 "vertex " + std::to_string(a + 1) + " has no VERTEX line");
}

TEST(ReadG2o, OrdersPosesWithoutVertexLinesById) {
  const auto file = read2("EDGE_SE2 9 2 0 0 0" + kIdentity3 + "\nEDGE_SE2 2 5 0 0 0" + kIdentity3 + "\n");
  EXPECT_EQ(file.pose_ids, (std::vector<std::uint64_t>{2, 5, 9}));
  EXPECT_EQ(file.graph.relative_poses[0].i, PoseId(2));
  EXPECT_EQ(file.graph.relative_poses[0].j, PoseId(0));
}

TEST(ReadG2o, TakesEntriesThatPrecedeTheirVertexLines) {
  const std::string vertices = "VERTEX_SE2 0 0 0 0\nVERTEX_XY 1 3 4\nVERTEX_SE2 2 1 0 0\n";
  const std::string factors =
      "FIX 0\nEDGE_RANGE 0 1 5 4\nEDGE_SE2 0 2 1 0 0" + kIdentity3 + "\nEDGE_SE2_XY 0 1 3 4 1 0 1\n";
  EXPECT_EQ(format_g2o(read2(factors + vertices)), format_g2o(read2(vertices + factors)));
}

TEST(ReadG2o, Takes64BitIdsAndKeepsDuplicateEdges) {
  const std::string edge = "EDGE_SE2 6989586621679009792 18446744073709551615 1 0 0" + kIdentity3 + "\n";
  const auto file = read2(edge + edge);
  EXPECT_EQ(file.pose_ids[0], 6989586621679009792u);
  EXPECT_EQ(file.graph.relative_poses.size(), 2u);
}

TEST(ReadG2o, TakesRangesBetweenPosesAndPoints) {
  const auto file = read2(
      "VERTEX_SE2 0 0 0 0\nVERTEX_XY 1 3 4\nVERTEX_SE2 2 1 0 0\n"
      "EDGE_RANGE 0 1 5 4\nEDGE_RANGE 0 2 1 100 0.1 0.2 -0.1 0\n");
  ASSERT_EQ(file.graph.ranges.size(), 2u);
  EXPECT_EQ(file.graph.points[0], Eigen::Vector2d(3, 4));
  EXPECT_EQ(file.graph.ranges[0].i.pose, PoseId(0));
  EXPECT_FALSE(file.graph.ranges[0].j.pose.valid());
  EXPECT_EQ(file.graph.ranges[0].j.point, PointId(0));
  EXPECT_EQ(file.graph.ranges[0].sigma_m, 0.5);
  EXPECT_EQ(file.graph.ranges[1].j.lever_arm, Eigen::Vector2d(-0.1, 0));
}

TEST(ReadG2o, ReadsByteOrderMarkAndCrLfAlike) {
  const std::string plain = "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nEDGE_SE2 0 1 1 0 0" + kIdentity3 + "\n";
  std::string windows = "\xef\xbb\xbf";
  for (const char c : plain) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(format_g2o(read2(plain)), format_g2o(read2(windows)));
}

TEST(ReadG2o, RefusesAnIndefiniteInformationWithItsLineAndTheirNumber) {
  const std::string good = "EDGE_SE2 0 1 1 0 0" + kIdentity3 + "\n";
  const std::string bad = "EDGE_SE2 0 1 1 0 0 1 2 0 1 0 1\n";
  expect_refused(good + bad + good + bad, 2, "the first such of 2 among 4");
  const auto file = read2(good + bad + good + bad, RepairInformation::kYes);
  EXPECT_EQ(file.repaired_informations, 2u);
  const Eigen::Matrix3d expected = (Eigen::Matrix3d() << 1.5, 1.5, 0, 1.5, 1.5, 0, 0, 0, 1).finished();
  EXPECT_LT((file.graph.relative_poses[1].information - expected).norm(), 1e-6);
}

TEST(ReadG2o, RefusesAZeroInformationUnlessItIsToBeRepaired) {
  const std::string good = "EDGE_SE2 0 1 1 0 0" + kIdentity3 + "\n";
  const std::string zero = "EDGE_SE2 0 1 5 0 0 0 0 0 0 0 0\n";
  expect_refused(good + zero, 2, "the information matrix is zero");
  expect_refused(good + "EDGE_PRIOR_SE2 0 1 0 0 0 0 0 0 0 0\n", 2, "the information matrix is zero");
  EXPECT_EQ(read2("EDGE_SE2 0 1 1 0 0 0 0 0 0 0 1\n").repaired_informations, 0u);  // yaw only
  const auto file = read2(good + zero, RepairInformation::kYes);
  EXPECT_EQ(file.repaired_informations, 1u);
  EXPECT_TRUE(file.graph.relative_poses[1].information.isZero(0));
}

TEST(ReadG2o, RefusesWhatItDoesNotKnow) {
  expect_refused("VERTEX_SE2 0 0 0 0\nVERTEX_CAM 1 0\n", 2, "unknown tag 'VERTEX_CAM'");
  expect_refused("0410268 0.7588833\n", 1, "unknown tag '0410268'");
  expect_refused("VERTEX_SE2 0 0 0 0\nVERTEX_XY 1 0 0\nEDGE_BEARING_SE2_XY 0 1 1 1\n", 3, "landmark");
  expect_refused("VERTEX_SE2 0 0 0 0\nVERTEX_SE3:QUAT 1 0 0 0 0 0 0 1\n", 2, "mixes 2D and 3D");
}

TEST(ReadG2o, RefusesMalformedLines) {
  expect_refused("VERTEX_SE2 0 0 0 0\nEDGE_SE2 0 1 1 0\n", 2, "before theta");
  expect_refused("VERTEX_SE2 0 0 0 0\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0", 2, "the file ends in this line");
  expect_refused("VERTEX_SE2 0 0 0 0 5\n", 1, "too many fields: unexpected '5'");
  expect_refused("VERTEX_SE2 0 nan 0 0\n", 1, "x 'nan' is not a finite number");
  expect_refused("VERTEX_SE2 0 0 1e9 0\n", 1, "plausible");
  expect_refused("VERTEX_SE2 0 0 0 inf\n", 1, "theta 'inf'");
  expect_refused("VERTEX_SE2 18446744073709551616 0 0 0\n", 1, "whole number");
  expect_refused("VERTEX_SE2 -1 0 0 0\n", 1, "whole number");
  expect_refused("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 0\n", 1, "the quaternion is zero");
}

TEST(ReadG2o, RefusesWhatDoesNotFitTogether) {
  expect_refused("VERTEX_SE2 0 0 0 0\nVERTEX_SE2 0 0 0 0\n", 2, "vertex 0 appears twice");
  expect_refused("EDGE_SE2 4 4 1 0 0" + kIdentity3 + "\n", 1, "to itself");
  expect_refused("VERTEX_SE2 0 0 0 0\nEDGE_SE2 0 1 1 0 0" + kIdentity3 + "\nVERTEX_SE2 2 0 0 0\n", 2,
                 "vertex 1 has no VERTEX line");
  expect_refused("VERTEX_SE2 0 0 0 0\nFIX 1\n", 2, "vertex 1 does not occur");
  expect_refused("VERTEX_SE2 0 0 0 0\nEDGE_RANGE 0 1 1 1\n", 2, "vertex 1 does not occur");
  expect_refused("VERTEX_SE2 0 0 0 0\nVERTEX_XY 1 0 0\nEDGE_SE2 0 1 1 0 0" + kIdentity3 + "\n", 3,
                 "is a point");
  expect_refused("VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 0 0 0\nEDGE_RANGE 0 1 1 0\n", 3, "not positive");
}

TEST(ReadG2o, RefusesAGraphWithoutPoses) {
  expect_refused("", 1, "empty");
  expect_refused("# nothing\n", 1, "no poses");
  expect_refused("VERTEX_XY 0 1 2\n", 1, "no poses");
}

TEST(WriteG2o, ReadsBackAsTheSameGraph) {
  const auto file = read2(
      "VERTEX_SE2 70 1 2 0.1\nVERTEX_SE2 3 4 5 7\nVERTEX_XY 1 3 4\nFIX 3\n"
      "EDGE_SE2 70 3 0.1 0.2 0.3 11 1 2 22 3 33\nEDGE_RANGE 70 1 5 4 0.1 0 0 0\n"
      "EDGE_PRIOR_SE2 70 1 2 3" +
      kIdentity3 + "\n");
  const std::string written = format_g2o(file);
  const auto again = read2(written);
  EXPECT_EQ(format_g2o(again), written);
  EXPECT_EQ(again.pose_ids, file.pose_ids);
  EXPECT_EQ(again.graph.poses[0].translation(), file.graph.poses[0].translation());
  EXPECT_EQ(again.graph.relative_poses[0].information, file.graph.relative_poses[0].information);
  EXPECT_EQ(again.graph.ranges[0].i.lever_arm, file.graph.ranges[0].i.lever_arm);
  EXPECT_EQ(again.graph.pose_fixed, file.graph.pose_fixed);
  EXPECT_EQ(again.graph.pose_priors.size(), 1u);
}

TEST(WriteG2o, ReadsBackInSpaceWithAPrior) {
  const auto file = read3(
      "VERTEX_SE3:QUAT 0 1 2 3 0 0 0.6 0.8\nVERTEX_SE3:QUAT 1 1 2 3 0 0 0 1\n"
      "PARAMS_SE3OFFSET 0 0 0 0 0 0 0 1\n"
      "EDGE_SE3:QUAT 0 1 1 2 3 0 0 0.6 0.8" +
      kIdentity6 + "\nEDGE_SE3_PRIOR 0 0 1 2 3 0 0 0.6 0.8" + kIdentity6 + "\n");
  const std::string written = format_g2o(file);
  EXPECT_EQ(format_g2o(read3(written)), written);
  EXPECT_EQ(file.graph.pose_priors.size(), 1u);
}

/// Sum of squared Mahalanobis norms near the optimum, from the definition of the chart.
double cost(const PoseGraph3& graph) {
  double sum = 0;
  for (const auto& factor : graph.relative_poses) {
    const SE3 error =
        factor.T_i_j.inverse() * graph.poses[factor.i.index()].inverse() * graph.poses[factor.j.index()];
    SE3::Tangent e = error.log();
    if (graph.chart == PoseChart::kG2o) e << error.translation(), error.rotation().vec();
    if (factor.drift.valid()) e -= factor.drift_jacobian * graph.drifts[factor.drift.index()];
    sum += factor.weight * e.dot(factor.information * e);
  }
  return sum;
}

TEST(WriteG2o, KeepsTheCostOfAnotherChartAWeightAndADrift) {
  PoseGraph3 graph;
  graph.poses = {SE3(), SE3::exp((SE3::Tangent() << 1.001, 0.002, 0, 0.001, -0.002, 0.303).finished())};
  graph.drifts = {{0.1, 0.05}};
  RelativePoseFactor<SE3>& factor = graph.relative_poses.emplace_back();
  factor.i = PoseId(0);
  factor.j = PoseId(1);
  factor.T_i_j = SE3::exp((SE3::Tangent() << 0.95, 0, 0, 0, 0, 0.2).finished());
  factor.information.diagonal() << 1, 2, 3, 40, 50, 60;
  factor.information(0, 5) = factor.information(5, 0) = 1;
  factor.weight = 0.5;
  factor.drift = DriftId(0);
  factor.drift_jacobian(5, 0) = 1;
  factor.drift_jacobian(0, 1) = 1;
  const auto written = read3(format_g2o(with_default_ids(graph)));
  EXPECT_NEAR(cost(written.graph) / cost(graph), 1, 0.02);
}

TEST(WriteG2o, CountsWhatTheFormatCannotHold) {
  PoseGraph2 graph;
  graph.poses.resize(1);
  graph.positions.resize(3);
  EXPECT_NE(format_g2o(with_default_ids(graph)).find("# not written: 3 positions\n"), std::string::npos);
}

}  // namespace
}  // namespace radioslam
