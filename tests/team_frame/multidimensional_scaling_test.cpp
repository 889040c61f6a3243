#include <gtest/gtest.h>

#include "radioslam/base/random.hpp"
#include "radioslam/team_frame/scaled_layouts.hpp"

namespace radioslam {
namespace {

Eigen::MatrixXd distances_between(const Eigen::Matrix2Xd& points) {
  const Eigen::Index n = points.cols();
  Eigen::MatrixXd distances(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) distances(i, j) = (points.col(i) - points.col(j)).norm();
  return distances;
}

Eigen::Matrix2Xd random_points(Eigen::Index count, std::uint64_t seed) {
  Rng rng(seed);
  return Eigen::Matrix2Xd::NullaryExpr(2, count, [&] { return rng.uniform(-30, 30); });
}

TEST(ClassicalScaling, RecoversPointsUpToARigidMotionAndMirroring) {
  for (const Eigen::Index count : {2, 3, 4, 10, 60}) {
    const auto distances = distances_between(random_points(count, static_cast<std::uint64_t>(count)));
    const auto recovered = classical_scaling(distances);
    ASSERT_EQ(recovered.cols(), count);
    EXPECT_LT((distances_between(recovered) - distances).cwiseAbs().maxCoeff(), 1e-6) << count;
    EXPECT_LT(recovered.rowwise().mean().norm(), 1e-6) << count;
  }
}

TEST(ClassicalScaling, RecoversPointsOfASquare) {
  Eigen::Matrix2Xd square(2, 4);  // equal eigenvalues: no axis comes first
  square << 0, 1, 1, 0, 0, 0, 1, 1;
  const auto distances = distances_between(square);
  EXPECT_LT((distances_between(classical_scaling(distances)) - distances).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(ClassicalScaling, BearsDistancesThatFitNoPlane) {
  const Eigen::Matrix2Xd points = random_points(60, 3);
  Eigen::MatrixXd distances = distances_between(points);
  Rng rng(4);
  for (Eigen::Index i = 0; i < 60; ++i)
    for (Eigen::Index j = 0; j < i; ++j)
      distances(i, j) = distances(j, i) = distances(i, j) * rng.uniform(0.8, 1.2);
  const Eigen::MatrixXd truth = distances_between(points);
  // Sixty points have far fewer coordinates than distances: most of the error averages out.
  EXPECT_LT((distances_between(classical_scaling(distances)) - truth).norm(),
            0.7 * (distances - truth).norm());
}

TEST(ClassicalScaling, OfOnePointOrNone) {
  EXPECT_EQ(classical_scaling(Eigen::MatrixXd::Zero(1, 1)), Eigen::Matrix2Xd::Zero(2, 1));
  EXPECT_EQ(classical_scaling(Eigen::MatrixXd(0, 0)).cols(), 0);
  EXPECT_LT(classical_scaling(Eigen::MatrixXd::Zero(5, 5)).norm(), 1e-9);
}

TEST(ClassicalScaling, IsTheSameOnEveryRun) {
  const auto distances = distances_between(random_points(30, 9));
  EXPECT_EQ(classical_scaling(distances), classical_scaling(distances));
}

}  // namespace
}  // namespace radioslam
