#include "radioslam/graph/pose_network.hpp"

#include <gtest/gtest.h>

#include "graph/random_graphs.hpp"

namespace radioslam {
namespace {

TEST(PoseNetwork2, SolvesAChainByHand) {
  // x_0 = 0 held, x_1 - x_0 = 1 with weight 1, x_2 - x_1 = 1 with weight 2, x_2 - x_0 = 3 with weight 1.
  PoseGraph2 graph;
  graph.poses.resize(3);
  NetworkTerms<SE2> terms;
  const auto add = [&](std::size_t i, std::size_t j, double difference, double weight) {
    auto& f = graph.relative_poses.emplace_back();
    f.i = PoseId(i);
    f.j = PoseId(j);
    NetworkTerm<2> term{Eigen::Matrix2d::Identity(), Eigen::Matrix2d::Zero(),
                        weight * Eigen::Matrix2d::Identity()};
    term.b(0, 0) = difference;
    terms.push_back(term);
  };
  add(0, 1, 1, 1);
  add(1, 2, 1, 2);
  add(0, 2, 3, 1);
  PoseNetworkSolver<SE2> solver(graph, {true, false, false});
  ASSERT_TRUE(solver.set_terms(terms));
  const auto x = solver.solve(1, PoseMatrices<SE2>(3, Eigen::Matrix2d::Zero()));
  ASSERT_TRUE(x);
  // 3 x_1 - 2 x_2 = -1, -2 x_1 + 3 x_2 = 5
  EXPECT_NEAR((*x)[1](0, 0), 1.4, 1e-12);
  EXPECT_NEAR((*x)[2](0, 0), 2.6, 1e-12);
  EXPECT_NEAR(solver.cost(1, *x), 0.16 + 2 * 0.04 + 0.16, 1e-12);
}

template <class Pose>
class PoseNetwork : public testing::Test {};
TYPED_TEST_SUITE(PoseNetwork, test::PoseTypes);

TYPED_TEST(PoseNetwork, HeldAtTheSolutionTheOthersStayThere) {
  const auto graph = test::draw_graph<TypeParam>(5, 20, 1, test::Extras::kNone);
  std::vector<bool> first(20, false), half(20, false);
  first[0] = true;
  for (std::size_t p = 0; p < 20; p += 2) half[p] = true;
  PoseMatrices<TypeParam> start;
  for (const auto& pose : graph.poses) start.push_back(pose.rotation_matrix().transpose());
  PoseNetworkSolver<TypeParam> whole(graph, first), part(graph, half);
  ASSERT_TRUE(whole.set_terms(rotation_terms(graph)));
  ASSERT_TRUE(part.set_terms(rotation_terms(graph)));
  const auto all = whole.solve(TypeParam::kDim, start);
  ASSERT_TRUE(all);
  const auto again = part.solve(TypeParam::kDim, *all);
  ASSERT_TRUE(again);
  for (std::size_t p = 0; p < 20; ++p) EXPECT_LT(((*all)[p] - (*again)[p]).norm(), 1e-9);
}

TYPED_TEST(PoseNetwork, WithoutWeightsItIsSingular) {
  auto graph = test::draw_graph<TypeParam>(5, 6, 1, test::Extras::kNone);
  for (auto& f : graph.relative_poses) f.weight = 0;
  PoseNetworkSolver<TypeParam> solver(graph, {true, false, false, false, false, false});
  EXPECT_FALSE(solver.set_terms(rotation_terms(graph)));
}

}  // namespace
}  // namespace radioslam
