#include <gtest/gtest.h>

#include <cmath>

#include "radioslam/base/random.hpp"
#include "radioslam/team_frame/field_refinement.hpp"

namespace radioslam {
namespace {

constexpr Eigen::Index kPlaces = 6;

std::vector<RigidBody> walks_of_a_hall(Rng& rng) {
  std::vector<RigidBody> bodies(10);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    bodies[b].first_node = b * static_cast<std::size_t>(kPlaces);
    bodies[b].points = Eigen::Matrix2Xd::NullaryExpr(2, kPlaces, [&] { return rng.uniform(-6, 6); });
    const double x = rng.uniform(0, 15), y = rng.uniform(0, 15), turn = rng.uniform(-3, 3);
    bodies[b].T_layout_body = SE2({x, y}, turn);
  }
  return bodies;
}

/// Decreases with the distance of the true positions.
Eigen::MatrixXd similarity_of(const std::vector<RigidBody>& bodies) {
  const Eigen::Matrix2Xd x = node_positions(bodies);
  return Eigen::MatrixXd::NullaryExpr(x.cols(), x.cols(), [&](Eigen::Index i, Eigen::Index j) {
    return std::exp(-(x.col(i) - x.col(j)).norm() / 20);
  });
}

void expect_unmoved(const std::vector<RigidBody>& bodies, const std::vector<RigidBody>& before,
                    std::size_t but) {
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (b == but) continue;
    EXPECT_EQ(bodies[b].T_layout_body.translation(), before[b].T_layout_body.translation()) << b;
    EXPECT_EQ(bodies[b].T_layout_body.angle(), before[b].T_layout_body.angle()) << b;
  }
}

TEST(RelocateOutliers, BringsBackTheOneThatIsFarOff) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
    Rng rng(seed);
    std::vector<RigidBody> bodies = walks_of_a_hall(rng);
    const Eigen::MatrixXd similarity = similarity_of(bodies);
    const SE2 truth = bodies[4].T_layout_body;
    bodies[4].T_layout_body = SE2(truth.translation() + Eigen::Vector2d(60, -40), truth.angle());
    const auto before = bodies;
    EXPECT_EQ(relocate_outliers(bodies, similarity), (std::vector<std::size_t>{4}));
    expect_unmoved(bodies, before, 4);
    EXPECT_LT((bodies[4].T_layout_body.translation() - truth.translation()).norm(), 6);
    EXPECT_EQ(bodies[4].T_layout_body.angle(), truth.angle());
  }
}

TEST(RelocateOutliers, LeavesTheNeighboursOfAnOutlier) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
    Rng rng(seed);
    std::vector<RigidBody> bodies = walks_of_a_hall(rng);
    // Two other robots took the outlier's path, so that their most similar fingerprints are far off.
    for (const std::size_t b : {3U, 5U}) {
      bodies[b].points = bodies[4].points.array() + 0.3;
      bodies[b].T_layout_body = bodies[4].T_layout_body;
    }
    bodies[5].points.array() -= 0.6;
    const Eigen::MatrixXd similarity = similarity_of(bodies);
    const SE2 truth = bodies[4].T_layout_body;
    bodies[4].T_layout_body = SE2(truth.translation() + Eigen::Vector2d(60, -40), truth.angle());
    const auto before = bodies;
    EXPECT_EQ(relocate_outliers(bodies, similarity), (std::vector<std::size_t>{4})) << seed;
    expect_unmoved(bodies, before, 4);
    EXPECT_LT((bodies[4].T_layout_body.translation() - truth.translation()).norm(), 1);
  }
}

TEST(RelocateOutliers, LeavesFixedBodiesAndSmallTeams) {
  Rng rng(6);
  std::vector<RigidBody> bodies = walks_of_a_hall(rng);
  const Eigen::MatrixXd similarity = similarity_of(bodies);
  bodies[4].T_layout_body = SE2({90, 90}, 0);
  bodies[4].fixed = true;
  for (const std::size_t b : relocate_outliers(bodies, similarity)) EXPECT_NE(b, 4U);
  bodies.resize(3);
  bodies[2].T_layout_body = SE2({90, 90}, 0);
  EXPECT_TRUE(relocate_outliers(bodies, similarity.topLeftCorner(3 * kPlaces, 3 * kPlaces)).empty());
}

TEST(RelocateOutliers, LeavesWhoeverIsLikeNobody) {
  Rng rng(7);
  std::vector<RigidBody> bodies = walks_of_a_hall(rng);
  Eigen::MatrixXd similarity = similarity_of(bodies);
  similarity.middleCols(4 * kPlaces, kPlaces).setZero();
  similarity.middleRows(4 * kPlaces, kPlaces).setZero();
  bodies[4].T_layout_body = SE2({90, 90}, 0);
  for (const std::size_t b : relocate_outliers(bodies, similarity)) EXPECT_NE(b, 4U);
}

}  // namespace
}  // namespace radioslam
