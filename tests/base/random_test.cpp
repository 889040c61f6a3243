#include "radioslam/base/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace radioslam {
namespace {

TEST(Rng, SameSeedSameStream) {
  Rng a(7), b(7);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(a.next(), b.next());
}

TEST(Rng, SplitDoesNotDependOnWhatWasDrawn) {
  Rng a(7), b(7);
  a.next();
  EXPECT_EQ(a.split("wifi").next(), b.split("wifi").next());
  EXPECT_NE(a.split("wifi").next(), a.split("odometry").next());
  EXPECT_NE(a.split(0).next(), a.split(1).next());
}

TEST(Rng, NormalHasUnitMoments) {
  Rng rng(1);
  constexpr int n = 200000;
  double sum = 0, squares = 0, fourth = 0;
  for (int i = 0; i < n; ++i) {
    const double x = rng.normal();
    sum += x;
    squares += x * x;
    fourth += x * x * x * x;
  }
  // Five standard errors of each moment.
  EXPECT_NEAR(sum / n, 0, 5 / std::sqrt(n));
  EXPECT_NEAR(squares / n, 1, 5 * std::sqrt(2.0 / n));
  EXPECT_NEAR(fourth / n, 3, 5 * std::sqrt(96.0 / n));
}

TEST(Rng, BelowIsUniform) {
  Rng rng(3);
  std::vector<int> seen(6, 0);
  for (int i = 0; i < 60000; ++i) ++seen[rng.below(6)];
  double chi2 = 0;
  for (const int s : seen) chi2 += (s - 10000.0) * (s - 10000.0) / 10000.0;
  EXPECT_LT(chi2, 25.7);  // chi-square, 5 degrees of freedom, p = 1e-4
}

}  // namespace
}  // namespace radioslam
