#include "radioslam/team_frame/field_refinement.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
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

Hall make_hall(Rng& rng) {
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
  Eigen::MatrixXd covariance(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      covariance(i, j) = 0.6 * std::exp(-(x.col(i) - x.col(j)).squaredNorm() / (2 * 12 * 12));
      if (i / kScans == j / kScans)
        covariance(i, j) += 0.2 * std::exp(-2.0 * std::abs(static_cast<double>(i - j)) / 15);
      if (i == j) covariance(i, j) += 0.05;
    }
  const Eigen::MatrixXd draws = Eigen::MatrixXd::NullaryExpr(n, kAccessPoints, [&] { return rng.normal(); });
  hall.heard = covariance.llt().matrixL() * draws;
  hall.heard.rowwise().normalize();
  return hall;
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
    refine_by_field(bodies, RadioField(hall.nodes, hall.heard, params.channels), params);
    after += error_m(bodies, hall.bodies);
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
  refine_by_field(bodies, RadioField(hall.nodes, hall.heard, 5), {});
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
  refine_by_field(bodies, field, params);
  refine_by_field(turned, field, params);
  for (std::size_t b = 0; b < kWalks; ++b)
    EXPECT_LT(((turn * bodies[b].T_layout_body).inverse() * turned[b].T_layout_body).log().norm(), 1e-4);
}

}  // namespace
}  // namespace radioslam
