#include "radioslam/consistency/chi_squared.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace radioslam {
namespace {

TEST(ChiSquared, QuantilesEqualTheTables) {
  const double at_95[] = {3.841, 5.991, 7.815, 9.488, 11.070, 12.592};
  const double at_99[] = {6.635, 9.210, 11.345, 13.277, 15.086, 16.812};
  const double at_999[] = {10.828, 13.816, 16.266, 18.467, 20.515, 22.458};
  const double at_1[] = {0.000157, 0.0201, 0.115, 0.297, 0.554, 0.872};
  for (int dof = 1; dof <= 6; ++dof) {
    EXPECT_NEAR(chi_squared_quantile(0.95, dof), at_95[dof - 1], 5.1e-4) << dof;
    EXPECT_NEAR(chi_squared_quantile(0.99, dof), at_99[dof - 1], 5.1e-4) << dof;
    EXPECT_NEAR(chi_squared_quantile(0.999, dof), at_999[dof - 1], 5.1e-4) << dof;
    EXPECT_NEAR(chi_squared_quantile(0.01, dof), at_1[dof - 1], 5.1e-4) << dof;
  }
}

TEST(ChiSquared, TwoDegreesOfFreedomHaveAClosedForm) {
  for (const double tail : {0.9, 0.5, 0.1, 1e-3, 1e-9})
    EXPECT_NEAR(chi_squared_quantile(1 - tail, 2), -2 * std::log(1 - (1 - tail)), 1e-9) << tail;
}

TEST(ChiSquared, TailInvertsTheQuantile) {
  for (int dof = 1; dof <= 40; ++dof)
    for (const double p : {0.001, 0.05, 0.3, 0.5, 0.9, 0.99, 0.99999}) {
      const double value = chi_squared_quantile(p, dof);
      EXPECT_NEAR(chi_squared_tail(value, dof), 1 - p, 1e-12) << dof << ' ' << p;
    }
}

TEST(ChiSquared, TailIsOneAtZeroAndFallsToNothing) {
  EXPECT_EQ(chi_squared_tail(0, 3), 1);
  EXPECT_EQ(chi_squared_tail(1e6, 3), 0);
}

TEST(ChiSquaredDeathTest, RefusesWhatIsNoProbability) {
  EXPECT_DEATH(chi_squared_quantile(1, 3), "probability");
  EXPECT_DEATH(chi_squared_quantile(0, 3), "probability");
  EXPECT_DEATH(chi_squared_tail(-1, 3), "squared norm");
  EXPECT_DEATH(chi_squared_tail(1, 0), "one dimension");
}

}  // namespace
}  // namespace radioslam
