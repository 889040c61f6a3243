#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "radioslam/sim/sensors/transmitters.hpp"

namespace radioslam {
namespace {

constexpr double kSigma_db = 5;
constexpr double kLength_m = 7;

/// Mean product of the field at two points `distance_m` apart, over many fields and points, per variance.
double correlation(double distance_m) {
  double products = 0;
  int count = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const ShadowingField field(kSigma_db, kLength_m, 64, Rng(seed));
    Rng rng = Rng(seed).split("places");
    for (int i = 0; i < 50; ++i) {
      const Eigen::Vector2d p(rng.uniform(0, 85), rng.uniform(0, 60));
      const double angle = rng.uniform(0, 2 * std::numbers::pi);
      const Eigen::Vector2d q = p + distance_m * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      products += field.at_db(p) * field.at_db(q);
      ++count;
    }
  }
  return products / count / (kSigma_db * kSigma_db);
}

TEST(ShadowingField, DecaysExponentiallyWithItsLength) {
  EXPECT_NEAR(correlation(0), 1, 0.06);
  EXPECT_NEAR(correlation(kLength_m / 2), std::exp(-0.5), 0.06);
  EXPECT_NEAR(correlation(kLength_m), std::exp(-1.0), 0.06);
  EXPECT_NEAR(correlation(2 * kLength_m), std::exp(-2.0), 0.06);
  EXPECT_NEAR(correlation(5 * kLength_m), 0, 0.06);
}

TEST(ShadowingField, IsNearlyGaussian) {
  double fourth = 0, second = 0;
  constexpr int n = 4000;
  for (std::uint64_t seed = 0; seed < n; ++seed) {
    const double x = ShadowingField(1, kLength_m, 64, Rng(seed)).at_db({10, 20});
    second += x * x;
    fourth += x * x * x * x;
  }
  // The kurtosis of a sum of m random-phase cosines is 3 - 3/(2m).
  EXPECT_NEAR(second / n, 1, 5 * std::sqrt(2.0 / n));
  EXPECT_NEAR(fourth / n, 3, 5 * std::sqrt(96.0 / n));
}

TEST(ShadowingField, StaysPut) {
  const ShadowingField a(kSigma_db, kLength_m, 64, Rng(1)), b(kSigma_db, kLength_m, 64, Rng(1));
  EXPECT_EQ(a.at_db({3, 4}), b.at_db({3, 4}));
  EXPECT_NE(a.at_db({3, 4}), ShadowingField(kSigma_db, kLength_m, 64, Rng(2)).at_db({3, 4}));
}

}  // namespace
}  // namespace radioslam
