#include "radioslam/radio/ranging/multilateration.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "radio/ranging/anchor_hall.hpp"

namespace radioslam {
namespace {

std::vector<RangeToAnchor> sights_of(const Eigen::VectorXd& position, const Eigen::MatrixXd& anchors,
                                     Rng& rng, double sigma_m) {
  std::vector<RangeToAnchor> sights;
  for (Eigen::Index a = 0; a < anchors.cols(); ++a)
    sights.push_back({static_cast<std::size_t>(a),
                      (position - anchors.col(a)).norm() + rng.normal(0, sigma_m),
                      sigma_m > 0 ? sigma_m : 0.1});
  return sights;
}

TEST(Multilateration, ExactRangesGiveThePosition) {
  Rng rng(1);
  const Eigen::MatrixXd anchors = test::hall_anchors();
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Vector2d truth(rng.uniform(-10, 35), rng.uniform(-10, 33));
    const auto three = sights_of(truth, anchors.leftCols(3), rng, 0),
               five = sights_of(truth, anchors, rng, 0);
    EXPECT_LT((multilaterate(anchors, three)->position_m - truth).norm(), 1e-6);
    EXPECT_LT((multilaterate(anchors, five)->position_m - truth).norm(), 1e-6);
  }
}

TEST(Multilateration, SpaceNeedsFour) {
  Eigen::Matrix3Xd anchors(3, 4);
  anchors << 0, 10, 0, 4, 0, 0, 9, 4, 0, 1, 2, 5;
  Rng rng(1);
  const Eigen::Vector3d truth(3, 4, 1);
  const auto sights = sights_of(truth, anchors, rng, 0);
  EXPECT_LT((multilaterate(anchors, sights)->position_m - truth).norm(), 1e-6);
  EXPECT_FALSE(multilaterate(anchors, {sights.begin(), sights.begin() + 3}).has_value());
}

TEST(Multilateration, CovarianceIsThatOfTheErrors) {
  constexpr int kDraws = 3000;
  Rng rng(3);
  MultilaterationParams least_squares;
  least_squares.loss_sigmas = 1e5;
  const Eigen::Vector2d truth(8, 15);
  double normalised = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const auto fix =
        multilaterate(test::hall_anchors(), sights_of(truth, test::hall_anchors(), rng, 0.1), least_squares);
    const Eigen::Vector2d error = fix->position_m - truth;
    normalised += error.dot(Eigen::Matrix2d(fix->covariance).ldlt().solve(error));
  }
  EXPECT_NEAR(normalised / kDraws, 2, 5 * 2 / std::sqrt(kDraws));
}

TEST(Multilateration, OneReflectedRangeIsDownWeighted) {
  Rng rng(4);
  const Eigen::Vector2d truth(8, 15);
  for (std::size_t wrong = 0; wrong < 5; ++wrong) {
    auto sights = sights_of(truth, test::hall_anchors(), rng, 0.05);
    sights[wrong].range_m += 4;
    const auto fix = multilaterate(test::hall_anchors(), sights);
    ASSERT_TRUE(fix.has_value());
    EXPECT_LT((fix->position_m - truth).norm(), 0.3) << wrong;
    EXPECT_LT(fix->weights[wrong], 0.01);
  }
}

TEST(Multilateration, RefusesWhatFixesNoPosition) {
  Eigen::Matrix2Xd line(2, 4);
  line << 0, 5, 9, 14, 0, 5, 9, 14;
  Rng rng(1);
  EXPECT_FALSE(multilaterate(line, sights_of(Eigen::Vector2d(3, 8), line, rng, 0)).has_value())
      << "mirror solution";
  const Eigen::MatrixXd anchors = test::hall_anchors();
  EXPECT_FALSE(multilaterate(anchors, {{0, 5, 1}, {1, 20, 1}}).has_value());
  EXPECT_FALSE(multilaterate(anchors, {{0, 5, 1}, {1, 20, 1}, {1, 20, 1}}).has_value()) << "two anchors only";
  EXPECT_FALSE(multilaterate(anchors, {}).has_value());
  MultilaterationParams params;
  params.max_sigma_m = 0.01;
  EXPECT_FALSE(
      multilaterate(anchors, sights_of(Eigen::Vector2d(8, 15), anchors, rng, 0.1), params).has_value());
}

}  // namespace
}  // namespace radioslam
