#include "radioslam/graph/graduated.hpp"

#include <gtest/gtest.h>

#include "graph/random_graphs.hpp"

namespace radioslam {
namespace {

/// A trajectory in which 2 of 5 loop closures are replaced by outliers.
template <class Pose>
struct Spoiled {
  PoseGraph<Pose> graph, clean;
  std::vector<bool> outlier;
};

template <class Pose>
Spoiled<Pose> spoiled(std::uint64_t seed) {
  Spoiled<Pose> s;
  s.graph = test::draw_graph<Pose>(seed, 60, 0.3, test::Extras::kNone);
  s.clean = s.graph;
  s.clean.relative_poses.clear();
  test::Drawing<Pose> draw(seed + 100);
  for (std::size_t k = 0; k < s.graph.relative_poses.size(); ++k) {
    auto& f = s.graph.relative_poses[k];
    const bool loop = f.j.index() != f.i.index() + 1;
    s.outlier.push_back(loop && k % 5 < 2);
    if (loop) f.loss = {LossKind::kGemanMcClure, 4};
    if (s.outlier.back()) f.T_i_j = draw.pose(10, 1);
    if (!s.outlier.back()) s.clean.relative_poses.push_back({f.i, f.j, f.T_i_j, f.information});
  }
  optimize(s.clean, {});
  for (const auto& f : s.graph.relative_poses)  // start from the odometry
    if (f.j.index() == f.i.index() + 1) s.graph.poses[f.j.index()] = s.graph.poses[f.i.index()] * f.T_i_j;
  return s;
}

template <class Pose>
class Graduated : public testing::Test {};
TYPED_TEST_SUITE(Graduated, test::PoseTypes);

TYPED_TEST(Graduated, TruncatedLeastSquaresFindsTheInlierSolutionAmongFortyPercentOutliers) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    auto [graph, clean, outlier] = spoiled<TypeParam>(seed);
    const auto mask = geman_mcclure_factors(graph);
    const auto summary = optimize_graduated(graph, mask, GraduatedLoss::kTruncatedLeastSquares, {}, {});
    for (std::size_t k = 0; k < outlier.size(); ++k)
      EXPECT_EQ(summary.weights.relative_poses[k], outlier[k] ? 0 : 1) << k;
    EXPECT_LT(test::max_difference(graph, clean), 1e-5);
  }
}

TYPED_TEST(Graduated, GemanMcClureEndsNearTheInlierSolution) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    auto [graph, clean, outlier] = spoiled<TypeParam>(seed);
    const auto mask = geman_mcclure_factors(graph);
    const auto summary = optimize_graduated(graph, mask, GraduatedLoss::kGemanMcClure, {}, {});
    for (std::size_t k = 0; k < outlier.size(); ++k)
      EXPECT_EQ(summary.weights.relative_poses[k] < 0.5, outlier[k]) << k;
    EXPECT_LT(test::max_difference(graph, clean), 0.5);
    EXPECT_NEAR(summary.last.final_cost, total_cost(graph), 1e-9 * total_cost(graph));
  }
}

TYPED_TEST(Graduated, LeavesMeasurementsAndWeightsAloneAndRepeatsItself) {
  const auto original = spoiled<TypeParam>(2).graph;
  auto first = original, second = original;
  const auto mask = geman_mcclure_factors(original);
  const auto loss = GraduatedLoss::kTruncatedLeastSquares;
  const auto a = optimize_graduated(first, mask, loss, {}, {});
  const auto b = optimize_graduated(second, mask, loss, {}, {});
  for (std::size_t i = 0; i < first.poses.size(); ++i) EXPECT_EQ(first.poses[i].log(), second.poses[i].log());
  EXPECT_EQ(a.weights.relative_poses, b.weights.relative_poses);
  for (std::size_t k = 0; k < original.relative_poses.size(); ++k) {
    EXPECT_EQ(first.relative_poses[k].weight, 1);
    EXPECT_EQ(first.relative_poses[k].loss.kind, original.relative_poses[k].loss.kind);
  }
}

TYPED_TEST(Graduated, AppliedWeightsGiveTheCostOfTheLastRound) {
  auto graph = spoiled<TypeParam>(1).graph;
  const auto mask = geman_mcclure_factors(graph);
  const auto summary = optimize_graduated(graph, mask, GraduatedLoss::kTruncatedLeastSquares, {}, {});
  apply_weights(summary.weights, mask, graph);
  EXPECT_NEAR(total_cost(graph), summary.last.final_cost, 1e-9 * summary.last.final_cost);
}

TYPED_TEST(Graduated, WithoutOutliersIsThePlainSolution) {
  auto graph = test::draw_graph<TypeParam>(5, 30, 0.3, test::Extras::kAll);
  auto plain = graph;
  optimize(plain, {});
  FactorMask mask;
  mask.ranges.assign(graph.ranges.size(), true);
  for (auto& f : graph.ranges) f.loss.scale = 100;
  const auto summary = optimize_graduated(graph, mask, GraduatedLoss::kTruncatedLeastSquares, {}, {});
  EXPECT_EQ(summary.rounds, 0);
  EXPECT_LT(test::max_difference(graph, plain), 1e-6);
}

}  // namespace
}  // namespace radioslam
