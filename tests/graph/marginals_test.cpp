// Marginal covariances against dense inversion and against sampling-free laws.
#include "radioslam/graph/marginals.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "graph/random_graphs.hpp"
#include "radioslam/graph/optimizer.hpp"

namespace radioslam {
namespace {

/// H of the normal equations, dense, built from the linearised factors without the block machinery.
template <class Pose>
Eigen::MatrixXd dense_information(const PoseGraph<Pose>& graph, const VariableBlocks& blocks,
                                  const SymmetricBlockMatrix& layout) {
  const auto n = static_cast<Eigen::Index>(layout.rows());
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(n, n);
  for_each_factor(graph, [&](const auto& factor) {
    const auto linear = linearise(graph, factor);
    const auto vars = variables(factor);
    Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(linear.residual.size(), n);
    for_each_index<std::tuple_size_v<decltype(vars)>>([&](auto k) {
      const auto block = blocks.of(vars[k]);
      if (block < 0) return;
      const auto b = static_cast<std::size_t>(block);
      const auto size = layout.pattern().sizes[b];
      jacobian.middleCols(static_cast<Eigen::Index>(layout.offset(b)), size) +=
          std::get<k>(linear.jacobians).leftCols(size);
    });
    const double s = weight(factor) * linear.residual.dot(information(factor) * linear.residual);
    h += weight(factor) * evaluate(loss(factor), s).weight * jacobian.transpose() * information(factor) *
         jacobian;
  });
  return h;
}

template <class Pose>
class MarginalsOf : public testing::Test {
 protected:
  void SetUp() override {
    graph = test::draw_graph<Pose>(4, 25, 1, test::Extras::kAll);
    for (auto& f : graph.ranges) f.loss = {LossKind::kCauchy, 1};
    optimize(graph, {});
    NormalEquations<Pose> equations(graph);
    blocks = equations.blocks();
    dense = dense_information(graph, blocks, equations.matrix()).inverse();
    for (std::size_t b = 0; b < equations.matrix().pattern().blocks(); ++b) {
      offsets.push_back(static_cast<Eigen::Index>(equations.matrix().offset(b)));
      sizes.push_back(equations.matrix().pattern().sizes[b]);
    }
  }
  Eigen::MatrixXd expected(const Variable& a, const Variable& b) const {
    const auto i = static_cast<std::size_t>(blocks.of(a)), j = static_cast<std::size_t>(blocks.of(b));
    return dense.block(offsets[i], offsets[j], sizes[i], sizes[j]);
  }

  PoseGraph<Pose> graph;
  VariableBlocks blocks;
  Eigen::MatrixXd dense;
  std::vector<Eigen::Index> offsets, sizes;
};
TYPED_TEST_SUITE(MarginalsOf, test::PoseTypes);

TYPED_TEST(MarginalsOf, EveryVariableEqualTheDenseInverse) {
  const auto marginals = Marginals<TypeParam>::compute(this->graph);
  ASSERT_TRUE(marginals.has_value());
  const auto close = [&](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    EXPECT_LT((a - b).norm(), 1e-9 * b.norm());
  };
  for (std::size_t i = 0; i < 25; ++i) {
    const auto v = variable(PoseId(i));
    close(marginals->pose(PoseId(i)), this->expected(v, v));
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const auto v = variable(PointId(i));
    close(marginals->point(PointId(i)), this->expected(v, v));
  }
  const auto drift = variable(DriftId(0));
  close(marginals->drift(DriftId(0)), this->expected(drift, drift));
  const auto bias = variable(BiasId(0));
  EXPECT_NEAR(marginals->range_bias_m2(BiasId(0)), this->expected(bias, bias)(0, 0), 1e-12);
}

TYPED_TEST(MarginalsOf, EveryPairEqualTheDenseInverse) {
  const auto marginals = Marginals<TypeParam>::compute(this->graph);
  std::vector<Variable> all{variable(PointId(0)), variable(PointId(1)), variable(DriftId(0)),
                            variable(BiasId(0)), variable(BiasId(1))};
  for (std::size_t i = 0; i < 25; ++i) all.push_back(variable(PoseId(i)));
  for (const auto& a : all)
    for (const auto& b : all) {
      if (a == b) continue;
      const auto joint = marginals->joint(a, b);
      const Eigen::MatrixXd cross = this->expected(a, b);
      EXPECT_LT((joint.topRightCorner(cross.rows(), cross.cols()) - cross).norm(), 1e-9);
      EXPECT_LT((joint - joint.transpose()).norm(), 1e-12);
      EXPECT_LT((joint.topLeftCorner(cross.rows(), cross.rows()) - this->expected(a, a)).norm(), 1e-9);
    }
}

template <class Pose>
class MarginalLaws : public testing::Test {};
TYPED_TEST_SUITE(MarginalLaws, test::PoseTypes);

TYPED_TEST(MarginalLaws, ARelativePoseOnAChainHasItsMeasurementsCovariance) {
  auto graph = test::draw_graph<TypeParam>(1, 4, 0, test::Extras::kNone);
  const auto marginals = Marginals<TypeParam>::compute(graph);
  ASSERT_TRUE(marginals.has_value());
  for (std::size_t k = 0; k < 3; ++k) {
    const typename TypeParam::Jacobian expected = graph.relative_poses[k].information.inverse();
    EXPECT_LT((marginals->relative_pose(PoseId(k), PoseId(k + 1)) - expected).norm(), 1e-9);
    const typename TypeParam::Jacobian ad = graph.relative_poses[k].T_i_j.adjoint();
    EXPECT_LT((marginals->relative_pose(PoseId(k + 1), PoseId(k)) - ad * expected * ad.transpose()).norm(),
              1e-8);
  }
  EXPECT_TRUE(marginals->relative_pose(PoseId(2), PoseId(2)).isZero(0));
  EXPECT_TRUE(marginals->pose(PoseId(0)).isZero(0)) << "the pose that holds the gauge is certain";
}

TYPED_TEST(MarginalLaws, AllRelativePosesAtOnceAreThoseOfPairs) {
  auto graph = test::draw_graph<TypeParam>(6, 30, 12, test::Extras::kNone);
  const auto marginals = Marginals<TypeParam>::compute(graph);
  ASSERT_TRUE(marginals.has_value());
  const std::vector<PoseId> of{PoseId(7), PoseId(0), PoseId(29), PoseId(7), PoseId(12)};  // 0 holds the gauge
  const auto all = marginals->relative_poses(of);
  std::size_t pair = 0;
  for (std::size_t a = 0; a < of.size(); ++a)
    for (std::size_t b = a + 1; b < of.size(); ++b) {
      ASSERT_LT(pair, all.size());
      const auto expected = marginals->relative_pose(of[a], of[b]);
      EXPECT_LT((all[pair++] - expected).norm(), 1e-9 * (1 + expected.norm())) << a << " " << b;
    }
  EXPECT_EQ(pair, all.size());
}

TYPED_TEST(MarginalLaws, NothingWhenSomethingIsNotObserved) {
  PoseGraph<TypeParam> graph;
  graph.poses.resize(1);
  graph.points.push_back(TypeParam::Point::Constant(2));
  graph.ranges.push_back(
      {{PoseId(0), {}, TypeParam::Point::Zero()}, {{}, PointId(0), TypeParam::Point::Zero()}, 2, 1, {}, 1});
  graph.ranges[0].weight = 0;
  EXPECT_FALSE(Marginals<TypeParam>::compute(graph).has_value());
  graph.ranges.clear();
  const auto untouched = Marginals<TypeParam>::compute(graph);
  ASSERT_TRUE(untouched.has_value());
  EXPECT_TRUE(std::isinf(untouched->point(PointId(0))(0, 0)));
}

}  // namespace
}  // namespace radioslam
