// Every factor, chart and kind of end against central differences.
#include <gtest/gtest.h>

#include "graph/random_graphs.hpp"
#include "radioslam/graph/normal_equations.hpp"

namespace radioslam {
namespace {

template <class Pose>
void move(PoseGraph<Pose>& graph, const Variable& v, int axis, double step) {
  const auto i = static_cast<std::size_t>(v.id);
  if (v.kind == VariableKind::kPose)
    graph.poses[i] = graph.poses[i] * Pose::exp(step * Pose::Tangent::Unit(axis));
  else if (v.kind == VariableKind::kPoint)
    graph.points[i][axis] += step;
  else if (v.kind == VariableKind::kDrift)
    graph.drifts[i][axis] += step;
  else
    graph.range_biases[i] += step;
}

template <class Pose>
int dimension(const Variable& v) {
  if (v.kind == VariableKind::kPose) return Pose::kDof;
  if (v.kind == VariableKind::kPoint) return Pose::kDim;
  if (v.kind == VariableKind::kDrift) return 2;
  return v.kind == VariableKind::kBias ? 1 : 0;
}

/// Largest difference between a factor's Jacobians and central differences of its residual.
template <class Pose, class Factor>
double jacobian_error(PoseGraph<Pose> graph, const Factor& factor) {
  constexpr double h = 1e-6;
  const auto linear = linearise(graph, factor);
  const auto vars = variables(factor);
  double worst = (linear.residual - residual(graph, factor)).norm();
  for_each_index<std::tuple_size_v<decltype(vars)>>([&](auto k) {
    const auto& jacobian = std::get<k>(linear.jacobians);
    for (int axis = 0; axis < dimension<Pose>(vars[k]); ++axis) {
      auto up = graph, down = graph;
      move(up, vars[k], axis, h);
      move(down, vars[k], axis, -h);
      const auto numerical = ((residual(up, factor) - residual(down, factor)) / (2 * h)).eval();
      worst = std::max(worst, (jacobian.col(axis) - numerical).norm());
    }
    const Eigen::Index used = dimension<Pose>(vars[k]);
    if (vars[k].kind == VariableKind::kPoint)
      worst = std::max(worst, jacobian.rightCols(jacobian.cols() - used).norm());
  });
  return worst;
}

template <class Pose>
class Jacobians : public testing::Test {};
TYPED_TEST_SUITE(Jacobians, test::PoseTypes);

TYPED_TEST(Jacobians, EqualCentralDifferencesForEveryFactorAndChart) {
  for (const auto chart : {PoseChart::kLogarithm, PoseChart::kG2o})
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      auto graph = test::draw_graph<TypeParam>(seed, 12, 1, test::Extras::kAll);
      graph.chart = chart;
      test::disturb(graph, seed, 0.5);
      for_each_factor(graph,
                      [&](const auto& f) { EXPECT_LT(jacobian_error(graph, f), 2e-7) << typeid(f).name(); });
    }
}

TYPED_TEST(Jacobians, CoverEveryKindOfEnd) {
  const auto graph = test::draw_graph<TypeParam>(1, 12, 1, test::Extras::kAll);
  int to_pose = 0, to_point = 0;
  const auto count = [&](const RangeEnd<TypeParam>& e) { ++(e.pose.valid() ? to_pose : to_point); };
  for (const auto& f : graph.ranges) count(f.j);
  EXPECT_TRUE(to_pose > 0 && to_point > 0);
  to_pose = to_point = 0;
  for (const auto& f : graph.bearings) count(f.j);
  EXPECT_TRUE(to_pose > 0 && to_point > 0);
  to_pose = to_point = 0;
  for (const auto& f : graph.relative_points) count(f.j);
  EXPECT_TRUE(to_pose > 0 && to_point > 0);
  to_pose = to_point = 0;
  for (const auto& f : graph.positions) count(f.i);
  EXPECT_TRUE(to_pose > 0 && to_point > 0);
}

TYPED_TEST(Jacobians, AreFiniteAndZeroAtDistanceZero) {
  using Point = typename TypeParam::Point;
  PoseGraph<TypeParam> graph;
  graph.poses = {TypeParam(), TypeParam()};
  const RangeFactor<TypeParam> range{
      {PoseId(0), {}, Point::Zero()}, {PoseId(1), {}, Point::Zero()}, 2, 1, {}, 1};
  const auto linear_range = linearise(graph, range);
  EXPECT_EQ(linear_range.residual[0], -2);
  EXPECT_TRUE(std::get<0>(linear_range.jacobians).isZero(0));
  EXPECT_TRUE(std::get<1>(linear_range.jacobians).isZero(0));
  const BearingFactor<TypeParam> bearing{PoseId(0), {PoseId(1), {}, Point::Zero()}, Point::UnitX(), 1, {}, 1};
  const auto linear_bearing = linearise(graph, bearing);
  EXPECT_TRUE(linear_bearing.residual.allFinite());
  EXPECT_TRUE(std::get<0>(linear_bearing.jacobians).isZero(0));
  EXPECT_TRUE(std::get<1>(linear_bearing.jacobians).isZero(0));
}

TEST(AzimuthOnly, IsComparedInTheBodysPlaneAndNothingElse) {
  auto graph = test::draw_graph<SE3>(5, 12, 1, test::Extras::kAll);
  for (BearingFactor<SE3> factor : graph.bearings) {
    factor.azimuth_only = true;
    const Eigen::Vector3d seen =
        (graph.poses[factor.i.index()] * factor.T_i_receiver).inverse() * position(graph, factor.j);
    const double azimuth_rad = std::atan2(seen.y(), seen.x());
    factor.direction = {std::cos(azimuth_rad), std::sin(azimuth_rad), 0};
    EXPECT_LT(residual(graph, factor).norm(), 1e-12);
    factor.direction = {std::cos(azimuth_rad + 0.3), std::sin(azimuth_rad + 0.3), 0};
    EXPECT_NEAR(residual(graph, factor).norm(), 2 * std::sin(0.15), 1e-12) << "the chord of the error";
    EXPECT_LT(jacobian_error(graph, factor), 2e-7);
  }
}

TEST(GravityPrior, IsTheTiltAndNoHeading) {
  const Eigen::Quaterniond tilted(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(0.4, Eigen::Vector3d(0.6, 0.8, 0)));
  const auto graph_turned = [&](const Eigen::Vector3d& axis, double angle_rad) {
    PoseGraph3 graph;
    graph.poses = {SE3({9, 9, 9}, Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, axis) * tilted))};
    PosePriorFactor<SE3>& prior = graph.pose_priors.emplace_back();
    prior.i = PoseId(0);
    prior.prior = SE3({3, -2, 1}, tilted);
    prior.gravity_only = true;
    return graph;
  };
  for (const double angle_rad : {0.0, 0.2, -1.0, 3.0}) {
    const auto turned = graph_turned(Eigen::Vector3d::UnitZ(), angle_rad);
    EXPECT_LT(residual(turned, turned.pose_priors[0]).norm(), 1e-15);
    const auto tipped = graph_turned(Eigen::Vector3d::UnitX(), angle_rad);
    EXPECT_NEAR(residual(tipped, tipped.pose_priors[0]).norm(), std::abs(std::sin(angle_rad)), 1e-12);
    EXPECT_LT(jacobian_error(tipped, tipped.pose_priors[0]), 2e-7);
    const auto linear = linearise(tipped, tipped.pose_priors[0]);
    const Eigen::Vector3d up = vertical_in_body(tipped.poses[0]);
    EXPECT_LT((std::get<0>(linear.jacobians).rightCols<3>() * up).norm(), 1e-15);
  }
}

TEST(Charts, G2oHalvesSmallRotationsInSpaceAndKeepsTheQuaternionsHalf) {
  PoseGraph3 graph;
  graph.chart = PoseChart::kG2o;
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitZ()));
  graph.poses = {SE3(), SE3({1, 2, 3}, Eigen::Quaterniond(-turn.coeffs()))};
  RelativePoseFactor<SE3> f;
  f.i = PoseId(0);
  f.j = PoseId(1);
  const auto r = residual(graph, f);
  EXPECT_NEAR(r[2], 3, 1e-15);
  EXPECT_NEAR(r[5], std::sin(0.01), 1e-15);
}

TEST(SquaredNorm, IsTheMahalanobisNormBeforeWeightAndLoss) {
  PoseGraph2 graph;
  graph.poses = {SE2(), SE2({3, 4}, 0)};
  const Eigen::Vector2d origin(0, 0);
  RangeFactor<SE2> f{{PoseId(0), {}, origin}, {PoseId(1), {}, origin}, 4, 0.5, {LossKind::kCauchy, 1}, 0.1};
  EXPECT_DOUBLE_EQ(squared_norm(graph, f), 4);
}

}  // namespace
}  // namespace radioslam
