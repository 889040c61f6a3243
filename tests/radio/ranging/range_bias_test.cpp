#include "radioslam/radio/ranging/range_bias.hpp"

#include <gtest/gtest.h>

#include "radio/ranging/anchor_hall.hpp"

namespace radioslam {
namespace {

TEST(RangeBias, IsFoundTogetherWithUnknownPositions) {
  Rng rng(2);
  Eigen::VectorXd truth(5);
  truth << 0.45, 0.2, 0.3, -0.1, 0.35;
  const auto epochs = test::hall_epochs(rng, 1500, 0.05, truth);
  const auto found = calibrate_positions(test::hall_anchors(), epochs, 5);
  for (Eigen::Index k = 0; k < 5; ++k) {
    const auto& bias = found.biases[static_cast<std::size_t>(k)];
    EXPECT_NEAR(bias.bias_m, truth[k], 0.02 + 4 * bias.sigma_m) << k;
    EXPECT_LT(bias.sigma_m, 0.02);
    EXPECT_EQ(bias.count, 1500U);
  }
  double squared_m2 = 0;
  for (std::size_t k = 0; k < epochs.size(); ++k)
    squared_m2 += (found.epochs[k]->position_m - test::hall_walk(0.1 * static_cast<double>(k))).squaredNorm();
  EXPECT_LT(std::sqrt(squared_m2 / 1500), 0.08);
  EXPECT_NEAR(found.noise_factor, 1, 0.15);

  RangeBiasParams none;
  none.prior_sigma_m = 0;
  const auto raw = calibrate_positions(test::hall_anchors(), epochs, 5, {}, none);
  EXPECT_EQ(raw.biases[0].bias_m, 0);
}

TEST(RangeBias, StaysNearZeroWhereUnobservable) {
  Rng rng(2);
  auto epochs = test::hall_epochs(rng, 50, 0.05, Eigen::VectorXd::Constant(5, 0.3));
  for (auto& epoch : epochs) epoch.ranges.resize(3);  // one more than coordinates
  const auto found = calibrate_positions(test::hall_anchors(), epochs, 5);
  const double prior = RangeBiasParams{}.prior_sigma_m;
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(found.biases[k].bias_m, 0.3, 3 * found.biases[k].sigma_m);
    EXPECT_LT(found.biases[k].sigma_m, prior);
  }
  for (std::size_t k = 3; k < 5; ++k) {
    EXPECT_EQ(found.biases[k].bias_m, 0);
    EXPECT_NEAR(found.biases[k].sigma_m, prior, 1e-9);
    EXPECT_EQ(found.biases[k].count, 0U);
  }
}

TEST(RangeBias, NoiseAboveTheStatedOneIsFound) {
  Rng rng(5);
  auto epochs = test::hall_epochs(rng, 500, 0.2, Eigen::VectorXd::Zero(5));
  for (auto& epoch : epochs)
    for (auto& range : epoch.ranges) range.sight.sigma_m = 0.05;
  EXPECT_NEAR(calibrate_positions(test::hall_anchors(), epochs, 5).noise_factor, 4, 0.6);
}

}  // namespace
}  // namespace radioslam
