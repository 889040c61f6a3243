#include "radioslam/team_frame/rigid_layout.hpp"

#include <gtest/gtest.h>

#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

constexpr Eigen::Index kPoints = 12;

SE2 random_pose(Rng& rng, double max_range_m, double turn_rad) {
  const double x = rng.uniform(-max_range_m, max_range_m), y = rng.uniform(-max_range_m, max_range_m);
  return {Eigen::Vector2d(x, y), rng.uniform(-turn_rad, turn_rad)};
}

std::vector<RigidBody> random_bodies(std::size_t count, Rng& rng) {
  std::vector<RigidBody> bodies(count);
  for (std::size_t b = 0; b < count; ++b) {
    bodies[b].first_node = b * static_cast<std::size_t>(kPoints);
    bodies[b].points = Eigen::Matrix2Xd::NullaryExpr(2, kPoints, [&] { return rng.uniform(-15, 15); });
    bodies[b].T_layout_body = random_pose(rng, 20, 3);
  }
  return bodies;
}

/// The bodies' true distances with equal weights.
PairTargets exact_targets(const std::vector<RigidBody>& bodies) {
  const Eigen::Matrix2Xd positions = node_positions(bodies);
  const Eigen::Index n = positions.cols();
  PairTargets targets{Eigen::MatrixXf(n, n), Eigen::MatrixXf::Ones(n, n), Eigen::MatrixXf::Ones(n, n)};
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      targets.distance_m(i, j) = static_cast<float>((positions.col(i) - positions.col(j)).norm());
  return targets;
}

/// Any symmetric distances and weights: some absent.
PairTargets random_targets(Eigen::Index n, Rng& rng) {
  PairTargets targets{Eigen::MatrixXf::Zero(n, n), Eigen::MatrixXf::Constant(n, n, 0.5F),
                      Eigen::MatrixXf::Zero(n, n)};
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < i; ++j) {
      targets.distance_m(i, j) = targets.distance_m(j, i) = static_cast<float>(rng.uniform(0, 40));
      const double weight = rng.uniform() < 0.3 ? 0 : rng.uniform(0.01, 1);
      targets.weight(i, j) = targets.weight(j, i) = static_cast<float>(weight);
    }
  return targets;
}

/// Largest difference between two layouts of the same bodies, in the frame of the first body.
double max_difference_m(const std::vector<RigidBody>& a, const std::vector<RigidBody>& b) {
  const SE2 T_b_a = b[0].T_layout_body * a[0].T_layout_body.inverse();
  Eigen::Matrix2Xd moved = T_b_a.rotation_matrix() * node_positions(a);
  moved.colwise() += T_b_a.translation();
  return (moved - node_positions(b)).colwise().norm().maxCoeff();
}

double squared_residual(const Eigen::Matrix2Xd& x, const PairTargets& targets, Eigen::Index i,
                        Eigen::Index j) {
  const double off = (x.col(i) - x.col(j)).norm() - static_cast<double>(targets.distance_m(i, j));
  return static_cast<double>(targets.information(i, j)) * off * off;
}

/// Sums over pairs of different bodies; a body has kPoints.
template <class Term>
double sum_over_pairs(const std::vector<RigidBody>& bodies, const Term& term) {
  const Eigen::Matrix2Xd x = node_positions(bodies);
  double sum = 0;
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    for (Eigen::Index j = 0; j < i; ++j)
      if (i / kPoints != j / kPoints) sum += term(x, i, j);
  return sum;
}

double layout_stress(const std::vector<RigidBody>& bodies, const PairTargets& targets) {
  return sum_over_pairs(bodies, [&](const auto& x, Eigen::Index i, Eigen::Index j) {
    return static_cast<double>(targets.weight(i, j)) * squared_residual(x, targets, i, j);
  });
}

TEST(LayoutCost, IsCauchysOfEveryPairAndTheHeadings) {
  Rng rng(4);
  auto bodies = random_bodies(3, rng);
  auto targets = random_targets(3 * kPoints, rng);
  for (Eigen::Index i = 0; i < 3 * kPoints; ++i)
    for (Eigen::Index j = 0; j < 3 * kPoints; ++j)
      if (i / kPoints == j / kPoints) targets.information(i, j) = 0;
  const double expected = sum_over_pairs(bodies, [&](const auto& x, Eigen::Index i, Eigen::Index j) {
    return static_cast<double>(targets.weight(i, j)) * std::log1p(squared_residual(x, targets, i, j)) / 2;
  });
  EXPECT_NEAR(layout_cost(bodies, targets), expected, 1e-6 * expected);
  bodies[1].sigma_heading_rad = bodies[2].sigma_heading_rad = 0.5;
  const double off_rad = wrap_angle(bodies[1].T_layout_body.angle() - bodies[2].T_layout_body.angle()) / 2;
  EXPECT_NEAR(layout_cost(bodies, targets), expected + 2 * (1 - std::cos(off_rad)) / 0.25, 1e-6 * expected);
}

TEST(FitLayout, RecoversALayoutThoughManyDistancesAreWrong) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Rng rng(seed);
    const auto truth = random_bodies(5, rng);
    PairTargets targets = exact_targets(truth);
    for (Eigen::Index i = 0; i < targets.distance_m.rows(); ++i)
      for (Eigen::Index j = 0; j < i; ++j)
        if (rng.uniform() < 0.2)
          targets.distance_m(i, j) = targets.distance_m(j, i) = static_cast<float>(rng.uniform(0, 80));
    auto bodies = truth;
    for (RigidBody& body : bodies) body.T_layout_body = random_pose(rng, 3, 0.3) * body.T_layout_body;
    const double before = layout_cost(bodies, targets);
    EXPECT_LT(fit_layout(bodies, targets, 100), before);
    EXPECT_LT(max_difference_m(bodies, truth), 0.3) << "seed " << seed;
  }
}

TEST(MajoriseStress, NeverRaisesTheStress) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Rng rng(seed);
    auto bodies = random_bodies(4, rng);
    bodies[2].fixed = seed % 2 == 0;
    const auto targets = random_targets(4 * kPoints, rng);
    const double first = layout_stress(bodies, targets);
    double last = first;
    for (int sweep = 0; sweep < 15; ++sweep) {
      majorise_stress(bodies, targets, 1);
      const double stress = layout_stress(bodies, targets);
      EXPECT_LE(stress, last * (1 + 1e-9)) << "seed " << seed << ", sweep " << sweep;
      last = stress;
    }
    EXPECT_LT(last, 0.99 * first) << "seed " << seed;
  }
}

TEST(MajoriseStress, RecoversALayoutFromItsDistances) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Rng rng(seed);
    const auto truth = random_bodies(5, rng);
    const auto targets = exact_targets(truth);
    auto bodies = truth;
    for (RigidBody& body : bodies) body.T_layout_body = body.T_layout_body * random_pose(rng, 5, 0.7);
    ASSERT_GT(max_difference_m(bodies, truth), 4);
    majorise_stress(bodies, targets, 300);
    EXPECT_LT(max_difference_m(bodies, truth), 0.5) << "seed " << seed;
  }
}

TEST(MajoriseStress, LeavesFixedBodiesWhereTheyAre) {
  Rng rng(3);
  const auto truth = random_bodies(3, rng);
  auto bodies = truth;
  bodies[0].fixed = true;
  bodies[1].T_layout_body = bodies[1].T_layout_body * random_pose(rng, 5, 0.5);
  bodies[2].T_layout_body = bodies[2].T_layout_body * random_pose(rng, 5, 0.5);
  majorise_stress(bodies, exact_targets(truth), 300);
  EXPECT_EQ(bodies[0].T_layout_body.translation(), truth[0].T_layout_body.translation());
  EXPECT_LT((node_positions(bodies) - node_positions(truth)).colwise().norm().maxCoeff(), 0.5);
}

TEST(MajoriseStress, AHeadingPriorHoldsBodiesToOneHeading) {
  Rng rng(4);
  auto bodies = random_bodies(3, rng);
  for (RigidBody& body : bodies) body.T_layout_body = SE2(body.T_layout_body.translation(), 0.3);
  const auto targets = random_targets(3 * kPoints, rng);
  auto free = bodies;
  for (RigidBody& body : bodies) body.sigma_heading_rad = 1e-4;
  majorise_stress(bodies, targets, 30);
  majorise_stress(free, targets, 30);
  double turned = 0;
  for (std::size_t b = 0; b < 3; ++b) {
    EXPECT_NEAR(bodies[b].T_layout_body.angle(), 0.3, 0.01);
    turned = std::max(turned, std::abs(free[b].T_layout_body.angle() - 0.3));
  }
  EXPECT_GT(turned, 0.1);
}

TEST(MajoriseStress, ABodyWithoutEvidenceStays) {
  Rng rng(5);
  auto bodies = random_bodies(2, rng);
  const auto before = node_positions(bodies);
  PairTargets targets = exact_targets(bodies);
  targets.distance_m *= 2;
  targets.weight.setZero();
  majorise_stress(bodies, targets, 10);
  EXPECT_EQ(node_positions(bodies), before);
}

}  // namespace
}  // namespace radioslam
