#include "radioslam/graph/chordal.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "graph/random_graphs.hpp"
#include "radioslam/graph/initial_values.hpp"
#include "radioslam/graph/optimizer.hpp"

namespace radioslam {
namespace {

/// Two unconnected trajectories and an isolated pose.
template <class Pose>
PoseGraph<Pose> two_walks(double noise) {
  auto graph = test::draw_graph<Pose>(1, 25, noise, test::Extras::kNone);
  const auto other = test::draw_graph<Pose>(2, 15, noise, test::Extras::kNone);
  const Pose away = test::Drawing<Pose>(3).pose(10, 1);
  for (const auto& pose : other.poses) graph.poses.push_back(away * pose);
  for (auto f : other.relative_poses) {
    f.i = PoseId(f.i.index() + 25);
    f.j = PoseId(f.j.index() + 25);
    graph.relative_poses.push_back(f);
  }
  graph.poses.push_back(away);
  return graph;
}

template <class Pose>
PoseGraph<Pose> forget_poses(PoseGraph<Pose> graph, const std::vector<std::size_t>& kept) {
  const auto poses = graph.poses;
  graph.poses.assign(poses.size(), Pose());
  for (const auto k : kept) graph.poses[k] = poses[k];
  return graph;
}

template <class Pose>
class Starts : public testing::Test {};
TYPED_TEST_SUITE(Starts, test::PoseTypes);

TYPED_TEST(Starts, ChordalIsExactWithoutNoiseInEveryComponent) {
  const auto truth = two_walks<TypeParam>(0);
  auto graph = forget_poses(truth, {0, 25, 40});
  EXPECT_EQ(initialise_chordal(graph), ChordalResult::kDone);
  EXPECT_LT(test::max_difference(graph, truth), 1e-9);
}

TYPED_TEST(Starts, SpanningTreeIsExactWithoutNoiseInEveryComponent) {
  const auto truth = two_walks<TypeParam>(0);
  auto graph = forget_poses(truth, {0, 25, 40});
  initialise_from_spanning_tree(graph);
  EXPECT_LT(test::max_difference(graph, truth), 1e-12);
}

TYPED_TEST(Starts, FixedPosesAreKeptAndUsed) {
  const auto truth = two_walks<TypeParam>(0);
  auto graph = forget_poses(truth, {10, 11, 30, 40});
  graph.pose_fixed.assign(41, false);
  graph.pose_fixed[10] = graph.pose_fixed[11] = graph.pose_fixed[30] = true;
  auto tree = graph;
  EXPECT_EQ(initialise_chordal(graph), ChordalResult::kDone);
  EXPECT_LT(test::max_difference(graph, truth), 1e-9);
  initialise_from_spanning_tree(tree);
  EXPECT_LT(test::max_difference(tree, truth), 1e-12);
}

TYPED_TEST(Starts, TheCheapestStartIsTaken) {
  auto graph = two_walks<TypeParam>(1);
  optimize(graph, {});
  const double optimum = total_cost(graph);
  auto given = graph;
  const auto from_optimum = initialise(given, GivenValues::kComplete);
  EXPECT_EQ(from_optimum.chosen, InitialValues::kGiven);
  EXPECT_EQ(total_cost(given), optimum);
  auto none = forget_poses(graph, {0, 25, 40});
  const auto from_edges = initialise(none, GivenValues::kNone);
  EXPECT_FALSE(from_edges.given.has_value());
  EXPECT_EQ(from_edges.chosen, InitialValues::kChordal);
  EXPECT_LT(*from_edges.chordal, *from_edges.spanning_tree);
  EXPECT_EQ(total_cost(none), *from_edges.chordal);
}

TYPED_TEST(Starts, WeightsOfZeroFallBackOnTheSpanningTree) {
  auto graph = test::draw_graph<TypeParam>(1, 10, 1, test::Extras::kNone);
  for (auto& f : graph.relative_poses) f.weight = 0;
  auto copy = graph;
  EXPECT_EQ(initialise_chordal(copy), ChordalResult::kNotPositiveDefinite);
  EXPECT_EQ(test::max_difference(copy, graph), 0);
  EXPECT_EQ(initialise(graph, GivenValues::kNone).chosen, InitialValues::kSpanningTree);
}

TYPED_TEST(Starts, AGraphWithoutMeasurementsKeepsItsPoses) {
  PoseGraph<TypeParam> graph;
  initialise(graph, GivenValues::kNone);
  EXPECT_TRUE(graph.poses.empty());
  graph.poses.push_back(test::Drawing<TypeParam>(1).pose(1, 1));
  const auto before = graph;
  initialise(graph, GivenValues::kNone);
  EXPECT_EQ(test::max_difference(before, graph), 0);
}

TEST(Starts2, ChordalReachesTheOptimumOfALargeLoopThatOdometryMisses) {
  // Two turns around a square with a heading bias: composing the odometry ends far off.
  PoseGraph2 graph;
  const std::size_t count = 161;
  graph.poses.resize(count);
  const auto add = [&](std::size_t i, std::size_t j, const SE2& T_i_j) {
    RelativePoseFactor<SE2> f;
    f.i = PoseId(i);
    f.j = PoseId(j);
    f.T_i_j = T_i_j;
    graph.relative_poses.push_back(f);
  };
  for (std::size_t i = 0; i + 1 < count; ++i)
    add(i, i + 1, SE2({1, 0}, (i % 20 == 19 ? std::numbers::pi / 2 : 0.0) + 0.02));
  for (std::size_t i = 0; i + 80 < count; i += 4) add(i, i + 80, SE2());
  initialise(graph, GivenValues::kNone);
  const double start = total_cost(graph);
  EXPECT_LT(optimize(graph, {}).final_cost, 0.15);
  EXPECT_LT(start, 10);
}

}  // namespace
}  // namespace radioslam
