#include "radioslam/radio/ranging/range_bias.hpp"

#include <gtest/gtest.h>

#include "radio/ranging/anchor_hall.hpp"

namespace radioslam {
namespace {

TEST(RangeBias, OfKnownGeometryIsTheMeanDespiteReflections) {
  Rng rng(1);
  std::vector<KnownRange> ranges;
  for (int k = 0; k < 2000; ++k) {
    const double distance_m = rng.uniform(1, 20);
    const double reflected_m = rng.uniform() < 0.1 ? rng.uniform(1, 10) : 0;
    ranges.push_back({0, distance_m + 0.3 + rng.normal(0, 0.05) + reflected_m, distance_m});
    ranges.push_back({2, distance_m - 0.2 + rng.normal(0, 0.1), distance_m});
  }
  const auto biases = biases_from_known_geometry(ranges, 3);
  EXPECT_NEAR(biases[0].bias_m, 0.3, 0.015);
  EXPECT_NEAR(biases[0].spread_m, 0.05, 0.01);
  EXPECT_EQ(biases[1].count, 0U);
  EXPECT_NEAR(biases[2].bias_m, -0.2, 4 * biases[2].sigma_m);
  EXPECT_NEAR(biases[2].sigma_m, 0.1 / std::sqrt(2000), 0.0005);
}

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
