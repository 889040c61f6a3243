#include "radioslam/graph/optimizer.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <numbers>

#include "graph/random_graphs.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/graph/normal_equations.hpp"

namespace radioslam {
namespace {

template <class Pose>
class Optimizer : public testing::Test {};
TYPED_TEST_SUITE(Optimizer, test::PoseTypes);

TYPED_TEST(Optimizer, RecoversPosesPointsAndDriftExactlyFromExactMeasurements) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto truth = test::draw_graph<TypeParam>(seed, 30, 0, test::Extras::kAll);
    ASSERT_LT(total_cost(truth), 1e-15);
    auto graph = truth;
    test::disturb(graph, seed, 0.1);
    const auto summary = optimize(graph, {});
    EXPECT_EQ(summary.termination, Termination::kConverged);
    EXPECT_LT(test::max_difference(graph, truth), 1e-7);
  }
}

TYPED_TEST(Optimizer, HoldsTheFirstPoseOfEveryComponentWithoutAbsoluteInformation) {
  auto graph = test::draw_graph<TypeParam>(3, 20, 0, test::Extras::kNone);
  const auto other = test::draw_graph<TypeParam>(4, 10, 0, test::Extras::kNone);
  for (auto f : other.relative_poses) {
    f.i = PoseId(f.i.index() + 20);
    f.j = PoseId(f.j.index() + 20);
    graph.relative_poses.push_back(f);
  }
  graph.poses.insert(graph.poses.end(), other.poses.begin(), other.poses.end());
  graph.poses.emplace_back();  // isolated
  const auto truth = graph;
  for (std::size_t i = 0; i < 31; ++i)
    if (i != 0 && i != 20) graph.poses[i] = graph.poses[i] * test::Drawing<TypeParam>(i).pose(0.1, 0.1);
  const auto lone = graph.poses[30];
  EXPECT_EQ(optimize(graph, {}).termination, Termination::kConverged);
  EXPECT_LT((lone.inverse() * graph.poses[30]).log().norm(), 1e-15);
  graph.poses[30] = truth.poses[30];
  EXPECT_LT(test::max_difference(graph, truth), 1e-7);
}

/// Robots of one pose each, before anything ties them: all poses are held.
TYPED_TEST(Optimizer, EquationsWithoutAFreePoseAreFactorised) {
  PoseGraph<TypeParam> graph;
  graph.poses.resize(3);
  NormalEquations<TypeParam> equations(graph);
  EXPECT_TRUE(equations.empty());
  EXPECT_EQ(equations.linearise(graph), 0);
  EXPECT_EQ(equations.factorize(0), Factorization::kDone);
  EXPECT_EQ(equations.factorize(1), Factorization::kDone);
}

TYPED_TEST(Optimizer, FixedPosesDoNotMove) {
  auto graph = test::draw_graph<TypeParam>(5, 20, 1, test::Extras::kAll);
  graph.pose_fixed.assign(20, false);
  graph.pose_fixed[7] = graph.pose_fixed[12] = true;
  test::disturb(graph, 5, 0.1);
  const auto before = graph;
  optimize(graph, {});
  for (const std::size_t i : {7U, 12U})
    EXPECT_EQ((before.poses[i].inverse() * graph.poses[i]).log().norm(), 0);
}

TYPED_TEST(Optimizer, TwoRunsAndAnyThreadsGiveTheSameBytes) {
  auto start = test::draw_graph<TypeParam>(6, 3000, 1, test::Extras::kAll);
  for (auto& f : start.ranges) f.loss = {LossKind::kCauchy, 1};
  std::vector<PoseGraph<TypeParam>> ends;
  for (const std::size_t threads : {1U, 2U, 4U, 4U}) {
    set_thread_count(threads);
    ends.push_back(start);
    optimize(ends.back(), {});
  }
  set_thread_count(0);
  for (const auto& end : ends) {
    for (std::size_t i = 0; i < end.poses.size(); ++i)
      EXPECT_TRUE(end.poses[i].log() == ends[0].poses[i].log());
    EXPECT_TRUE(end.points == ends[0].points);
    EXPECT_TRUE(end.drifts == ends[0].drifts);
  }
}

TYPED_TEST(Optimizer, ReturnsTheBestValuesSeenAndTheirCost) {
  auto graph = test::draw_graph<TypeParam>(7, 40, 3, test::Extras::kAll);
  test::disturb(graph, 7, 1.5);
  OptimizerParams params;
  for (const int iterations : {1, 2, 3, 5, 100}) {
    auto copy = graph;
    params.max_iterations = iterations;
    const auto summary = optimize(copy, params);
    EXPECT_NEAR(summary.final_cost, total_cost(copy), 1e-9 * summary.final_cost);
    EXPECT_LE(summary.final_cost, *std::min_element(summary.costs.begin(), summary.costs.end()));
    EXPECT_EQ(summary.costs.size(), static_cast<std::size_t>(summary.iterations) + 1);
    if (iterations == 1) {
      EXPECT_EQ(summary.termination, Termination::kMaxIterations);
    }
  }
}

TYPED_TEST(Optimizer, GradientIsHalfTheDerivativeOfTheCost) {
  auto graph = test::draw_graph<TypeParam>(8, 10, 3, test::Extras::kAll);
  test::disturb(graph, 8, 0.3);
  for (auto& f : graph.ranges) f.loss = {LossKind::kCauchy, 0.7};
  for (auto& f : graph.bearings) f.loss = {LossKind::kHuber, 0.7};
  for (auto& f : graph.positions) f.loss = {LossKind::kGemanMcClure, 2};
  NormalEquations<TypeParam> equations(graph);
  EXPECT_NEAR(equations.linearise(graph), total_cost(graph), 1e-9 * total_cost(graph));
  for (Eigen::Index k = 0; k < equations.gradient().size(); ++k) {
    const Eigen::VectorXd step = 1e-6 * Eigen::VectorXd::Unit(equations.gradient().size(), k);
    auto up = graph, down = graph;
    equations.apply(step, up);
    equations.apply(-step, down);
    const double numerical = (total_cost(up) - total_cost(down)) / 2e-6;
    EXPECT_NEAR(2 * equations.gradient()[k], numerical, 1e-5 * (1 + std::abs(numerical)));
  }
}

TYPED_TEST(Optimizer, AMeasurementOfAPoseAgainstItselfOnlyCosts) {
  auto graph = test::draw_graph<TypeParam>(9, 10, 0, test::Extras::kNone);
  RelativePoseFactor<TypeParam> loop;
  loop.i = loop.j = PoseId(4);
  loop.T_i_j = TypeParam::exp(0.1 * TypeParam::Tangent::Unit(0));
  graph.relative_poses.push_back(loop);
  EXPECT_NEAR(optimize(graph, {}).final_cost, 0.01, 1e-12);
}

TYPED_TEST(Optimizer, NothingToDoWithoutFactorsOrFreeVariables) {
  PoseGraph<TypeParam> graph;
  EXPECT_EQ(optimize(graph, {}).termination, Termination::kNothingToDo);
  graph = test::draw_graph<TypeParam>(1, 10, 1, test::Extras::kNone);
  graph.pose_fixed.assign(10, true);
  const auto summary = optimize(graph, {});
  EXPECT_EQ(summary.termination, Termination::kNothingToDo);
  EXPECT_GT(summary.final_cost, 0);
}

TYPED_TEST(Optimizer, APartlyObservedGaugeLeavesTheOptimumAlone) {
  // A single position fix: the rotation about it is free, and must not hold back the rest.
  const auto truth = test::draw_graph<TypeParam>(2, 15, 0, test::Extras::kNone);
  auto graph = truth;
  test::disturb(graph, 2, 0.1);
  PositionFactor<TypeParam> fix;
  fix.i.pose = PoseId(9);
  fix.position = truth.poses[9].translation() + TypeParam::Point::Constant(3);
  graph.positions.push_back(fix);
  const auto summary = optimize(graph, {});
  EXPECT_EQ(summary.termination, Termination::kConverged);
  EXPECT_LT(summary.final_cost, 1e-12);
}

TYPED_TEST(Optimizer, RangesAloneBetweenPosesSettleWithoutHeadings) {
  using Point = typename TypeParam::Point;
  test::Drawing<TypeParam> draw(11);
  PoseGraph<TypeParam> graph;
  for (int i = 0; i < 6; ++i) graph.poses.push_back(draw.pose(5, 1));
  const auto truth = graph;
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = i + 1; j < 6; ++j) {
      const double d = (truth.poses[i].translation() - truth.poses[j].translation()).norm();
      graph.ranges.push_back({{PoseId(i), {}, Point::Zero()}, {PoseId(j), {}, Point::Zero()}, d, 0.1, {}, 1});
    }
  test::disturb(graph, 11, 0.1);
  EXPECT_LT(optimize(graph, {}).final_cost, 1e-9);
}

TYPED_TEST(Optimizer, AllEndsInOnePlaceEndsWithoutProgressOrCrash) {
  using Point = typename TypeParam::Point;
  PoseGraph<TypeParam> graph;
  graph.poses.resize(3);
  graph.ranges.push_back({{PoseId(0), {}, Point::Zero()}, {PoseId(1), {}, Point::Zero()}, 2, 1, {}, 1});
  graph.ranges.push_back({{PoseId(1), {}, Point::Zero()}, {PoseId(2), {}, Point::Zero()}, 2, 1, {}, 1});
  const auto summary = optimize(graph, {});
  EXPECT_EQ(summary.final_cost, 8);
}

TEST(Optimizer2, AWeightScalesTheInformation) {
  PoseGraph2 graph;
  graph.poses.resize(1);
  PosePriorFactor<SE2> prior;
  prior.i = PoseId(0);
  graph.pose_priors = {prior, prior};
  graph.pose_priors[0].prior = SE2({1, 0}, 0);
  graph.pose_priors[0].weight = 3;
  optimize(graph, {});
  EXPECT_NEAR(graph.poses[0].translation().x(), 0.75, 1e-12);
}

TEST(Optimizer2, ACauchyLossDiscountsAnOutlier) {
  PoseGraph2 graph;
  graph.poses.resize(1);
  for (int k = 0; k < 9; ++k) {
    PositionFactor<SE2> f;
    f.i.pose = PoseId(0);
    f.position = {k == 0 ? 50.0 : 0.01 * (k - 4.5), 0};
    f.loss = {LossKind::kCauchy, 0.1};
    graph.positions.push_back(f);
  }
  optimize(graph, {});
  EXPECT_NEAR(graph.poses[0].translation().x(), 0, 0.01);
}

TEST(OptimizerParams, FieldsHoldTheirDefaults) {
  OptimizerParams params;
  int count = 0;
  OptimizerParams::visit_fields(params, [&](const Field& field, auto& value) {
    EXPECT_GE(static_cast<double>(value), field.minimum) << field.name;
    EXPECT_LE(static_cast<double>(value), field.maximum) << field.name;
    ++count;
  });
  EXPECT_EQ(count, 9);
}

/// Two laps of a ring of poses on top of each other, exact odometry with a scale error as a variable, and a
/// pull of `weight` between any two within 2 m.
PoseGraph2 two_laps(double weight, DriftId scale_source) {
  constexpr int kLap = 60, kPoses = 2 * kLap;
  constexpr double kStep_m = 1, kSigma_m = 0.02, kSigmaScale = 0.02, kNear_m = 2.5, kSigmaNear_m = 2;
  PoseGraph2 graph;
  graph.drifts = {Drift::Zero()};
  graph.drift_priors = {
      {DriftId(0), Drift::Zero(), Eigen::Vector2d(1e12, 1 / (kSigmaScale * kSigmaScale)).asDiagonal()}};
  const SE2 step({kStep_m, 0}, 2 * std::numbers::pi / kLap);
  for (int k = 0; k < kPoses; ++k) {
    graph.poses.push_back(k == 0 ? SE2() : graph.poses.back() * step);
    if (k == 0) continue;
    RelativePoseFactor<SE2> odometry{PoseId(k - 1), PoseId(k), step};
    odometry.information /= kSigma_m * kSigma_m;
    odometry.drift = DriftId(0);
    odometry.drift_jacobian.col(1) = -(step.inverse().adjoint() * Eigen::Vector3d(kStep_m, 0, 0));
    graph.relative_poses.push_back(odometry);
  }
  for (int i = 0; i < kPoses; ++i)
    for (int j = i + 1; j < kPoses; ++j) {
      RangeFactor<SE2> near{{PoseId(i)}, {PoseId(j)}, 0, kSigmaNear_m};
      near.drift = scale_source;
      near.weight = weight;
      if ((graph.poses[PoseId(i).index()].translation() - graph.poses[PoseId(j).index()].translation())
              .norm() < kNear_m)
        graph.ranges.push_back(near);
    }
  return graph;
}

TEST(Optimizer, PairsScaledByAnOdometryDoNotShrinkItHoweverMany) {
  for (const double weight : {1.0, 10.0}) {
    auto scaled = two_laps(weight, DriftId(0)), unscaled = two_laps(weight, DriftId());
    optimize(scaled, OptimizerParams{});
    optimize(unscaled, OptimizerParams{});
    EXPECT_NEAR(scaled.drifts[0][1], 0, 0.003) << weight;
    EXPECT_GT(unscaled.drifts[0][1], 0.03) << weight;  // the pull towards distance 0 favours a shorter path
  }
}

}  // namespace
}  // namespace radioslam
