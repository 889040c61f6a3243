#include "radioslam/team_frame/field_refinement.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "radioslam/base/random.hpp"
#include "radioslam/geometry/alignment.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kWalks = 12;
constexpr Eigen::Index kScans = 10;
constexpr Eigen::Index kAccessPoints = 60;

/// Straight trajectories across a hall of 60 m with fingerprints drawn from the field, per-robot errors
/// included.
struct Hall {
  std::vector<RigidBody> bodies;  ///< true poses
  std::vector<FieldNode> nodes;
  Eigen::MatrixXd heard;
};

Hall make_hall(Rng& rng, const std::vector<double>& losses = std::vector<double>(kWalks, 0)) {
  Hall hall;
  for (std::size_t w = 0; w < kWalks; ++w) {
    RigidBody& body = hall.bodies.emplace_back();
    body.first_node = w * kScans;
    body.points.resize(2, kScans);
    for (Eigen::Index k = 0; k < kScans; ++k) {
      body.points.col(k) << 2.5 * static_cast<double>(k), std::sin(static_cast<double>(k));
      hall.nodes.push_back({w, Stamp{static_cast<std::int64_t>(k) * 2'000'000'000}});
    }
    const double x = rng.uniform(0, 60), y = rng.uniform(0, 60), turn = rng.uniform(-3, 3);
    body.T_layout_body = SE2({x, y}, turn);
    body.sigma_heading_rad = 0.2;
  }
  const Eigen::Matrix2Xd x = node_positions(hall.bodies);
  const Eigen::Index n = x.cols();
  const auto shared = [&](Eigen::Index i) { return std::exp(-losses[static_cast<std::size_t>(i / kScans)]); };
  Eigen::MatrixXd covariance(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      covariance(i, j) = 0.6 * std::exp(-(x.col(i) - x.col(j)).squaredNorm() / (2 * 12 * 12));
      if (i / kScans != j / kScans) covariance(i, j) *= shared(i) * shared(j);
      if (i / kScans == j / kScans)
        covariance(i, j) += 0.2 * std::exp(-2.0 * std::abs(static_cast<double>(i - j)) / 15);
      if (i == j) covariance(i, j) += 0.05;
    }
  const Eigen::MatrixXd draws = Eigen::MatrixXd::NullaryExpr(n, kAccessPoints, [&] { return rng.normal(); });
  hall.heard = covariance.llt().matrixL() * draws;
  hall.heard.rowwise().normalize();
  return hall;
}

FieldFit fit_of(const std::vector<RigidBody>& bodies) {
  return {bodies, FieldModel::nominal(bodies.size()), 0};
}

std::vector<RigidBody> displaced(std::vector<RigidBody> bodies, Rng& rng) {
  for (RigidBody& body : bodies) {
    const double x = rng.normal() * 5, y = rng.normal() * 5;
    body.T_layout_body = SE2(body.T_layout_body.translation() + Eigen::Vector2d(x, y),
                             body.T_layout_body.angle() + 0.15 * rng.normal());
  }
  return bodies;
}

/// Mean distance of the nodes from the truth after one rigid alignment of all.
double error_m(const std::vector<RigidBody>& bodies, const std::vector<RigidBody>& truth) {
  const Eigen::Matrix2Xd x = node_positions(bodies), wanted = node_positions(truth);
  const SE2 T = align_points(x, wanted);
  double sum = 0;
  for (Eigen::Index i = 0; i < x.cols(); ++i) sum += (T * Eigen::Vector2d(x.col(i)) - wanted.col(i)).norm();
  return sum / static_cast<double>(x.cols());
}

TEST(RefineByField, BringsWalksBackToWhereTheyWere) {
  double before = 0, after = 0;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    Rng rng(seed);
    const Hall hall = make_hall(rng);
    std::vector<RigidBody> bodies = displaced(hall.bodies, rng);
    for (auto& body : bodies) body.sigma_heading_rad = 0;
    before += error_m(bodies, hall.bodies);
    FieldParams params;
    params.channels = 20;
    params.iterations = 100;
    FieldFit fit = fit_of(bodies);
    refine_by_field(fit, RadioField(hall.nodes, hall.heard, params.channels), params);
    after += error_m(fit.bodies, hall.bodies);
  }
  EXPECT_GT(before, 3 * 4.0);
  EXPECT_LT(after, before / 2);
}

TEST(RefineByField, LeavesFixedBodiesAndThoseWithoutPoints) {
  Rng rng(4);
  const Hall hall = make_hall(rng);
  std::vector<RigidBody> bodies = displaced(hall.bodies, rng);
  bodies[2].fixed = true;
  RigidBody& empty = bodies.emplace_back();
  empty.first_node = kWalks * kScans;
  empty.points.resize(2, 0);
  const std::vector<RigidBody> before = bodies;
  FieldFit fit = fit_of(bodies);
  refine_by_field(fit, RadioField(hall.nodes, hall.heard, 5), {});
  bodies = fit.bodies;
  for (const std::size_t b : {std::size_t{2}, kWalks}) {
    EXPECT_EQ(bodies[b].T_layout_body.translation(), before[b].T_layout_body.translation());
    EXPECT_EQ(bodies[b].T_layout_body.angle(), before[b].T_layout_body.angle());
  }
  EXPECT_NE(bodies[0].T_layout_body.translation(), before[0].T_layout_body.translation());
}

TEST(RefineByField, TurnsWithTheLayout) {  // with a common heading the cost is rotation invariant
  Rng rng(5);
  const Hall hall = make_hall(rng);
  std::vector<RigidBody> bodies = displaced(hall.bodies, rng);
  for (auto& body : bodies) body.sigma_heading_rad = 0.2;
  std::vector<RigidBody> turned = bodies;
  const SE2 turn({7, -3}, 0.7);
  for (RigidBody& body : turned) body.T_layout_body = turn * body.T_layout_body;
  FieldParams params;
  params.iterations = 5;
  const RadioField field(hall.nodes, hall.heard, params.channels);
  FieldFit fit = fit_of(bodies), turned_fit = fit_of(turned);
  refine_by_field(fit, field, params);
  refine_by_field(turned_fit, field, params);
  for (std::size_t b = 0; b < kWalks; ++b)
    EXPECT_LT(
        ((turn * fit.bodies[b].T_layout_body).inverse() * turned_fit.bodies[b].T_layout_body).log().norm(),
        1e-4);
}

/// Phones that hear less of what others hear are no further from them.
TEST(RefineByField, FindsTheLossesOfDeafPhones) {
  double deaf = 0, others = 0;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    Rng rng(seed);
    std::vector<double> losses(kWalks, 0.05);
    losses[3] = losses[7] = 0.7;
    const Hall hall = make_hall(rng, losses);
    FieldParams params;
    params.channels = 20;
    params.iterations = 100;
    FieldFit fit = fit_of(hall.bodies);
    refine_by_field(fit, RadioField(hall.nodes, hall.heard, params.channels), params);
    for (std::size_t b = 0; b < kWalks; ++b)
      (b == 3 || b == 7 ? deaf : others) += std::exp(fit.model.log_losses[static_cast<Eigen::Index>(b)]);
    EXPECT_LT(error_m(fit.bodies, hall.bodies), 5) << seed;
  }
  EXPECT_GT(deaf / 6, 3 * others / (3 * (kWalks - 2)));
}

/// In one of the halls the walk lies alone, and nothing says where.
TEST(RelocateByField, BringsBackTheOneThatIsFarOff) {
  int brought_back = 0;
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
    Rng rng(seed);
    const Hall hall = make_hall(rng);
    FieldFit fit = fit_of(hall.bodies);
    SE2& displaced = fit.bodies[4].T_layout_body;
    displaced = SE2(displaced.translation() + Eigen::Vector2d(60, -40), displaced.angle());
    const TeamField team{RadioField(hall.nodes, hall.heard, 20), hall.heard * hall.heard.transpose()};
    EXPECT_LE(relocate_by_field(fit, team).size(), 3U) << seed;
    const Eigen::Vector2d off =
        fit.bodies[4].T_layout_body.translation() - hall.bodies[4].T_layout_body.translation();
    if (off.norm() < 12) ++brought_back;
  }
  EXPECT_EQ(brought_back, 4);
}

TEST(AdvanceByField, KeepsTheSizeOfTheLayoutAndFixedBodies) {
  Rng rng(6);
  const Hall hall = make_hall(rng);
  const auto spread = [](const std::vector<RigidBody>& bodies) {
    const Eigen::Matrix2Xd x = node_positions(bodies);
    return (x.colwise() - x.rowwise().mean()).norm();
  };
  const TeamField team{RadioField(hall.nodes, hall.heard, 5), hall.heard * hall.heard.transpose()};
  FieldFit fit = fit_of(displaced(hall.bodies, rng));
  const double before = spread(fit.bodies);
  advance_by_field(fit, team, {}, true);
  EXPECT_NEAR(spread(fit.bodies), before, 0.02 * before);
  fit = fit_of(displaced(hall.bodies, rng));
  fit.bodies[2].fixed = true;
  const SE2 held = fit.bodies[2].T_layout_body;
  advance_by_field(fit, team, {}, true);
  advance_by_field(fit, team, {}, false);
  EXPECT_EQ(fit.bodies[2].T_layout_body.translation(), held.translation());
}

}  // namespace
}  // namespace radioslam
