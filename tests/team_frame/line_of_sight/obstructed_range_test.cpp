// The likelihood of a distance under a detour: its derivatives, and both tails.
#include <gtest/gtest.h>

#include <cmath>

#include "radioslam/team_frame/line_of_sight/detour_continuity.hpp"

namespace radioslam {
namespace {

constexpr double kRangeSigma_m = 0.5;

TEST(ObstructedRange, IsHalfWhereTheRangeIsTheDistanceAndOneBeyond) {
  EXPECT_NEAR(obstructed_range(0, kRangeSigma_m).probability, 0.5, 1e-15);
  EXPECT_NEAR(obstructed_range(kRangeSigma_m, kRangeSigma_m).probability, 0.8413447460685429, 1e-15);
  EXPECT_EQ(obstructed_range(100, kRangeSigma_m).probability, 1);
  EXPECT_LT(obstructed_range(-5, kRangeSigma_m).probability, 1e-20);
}

TEST(ObstructedRange, DerivativesAreThoseOfTheLogProbability) {
  constexpr double kStep = 1e-5;
  for (const double x : {-3.0, -2.6, -2.4, -1.0, -0.2, 0.0, 0.3, 1.0, 2.0}) {
    const double more = std::log(obstructed_range(x + kStep, kRangeSigma_m).probability);
    const double less = std::log(obstructed_range(x - kStep, kRangeSigma_m).probability);
    const ObstructedRange at = obstructed_range(x, kRangeSigma_m);
    EXPECT_NEAR(at.slope, (more - less) / (2 * kStep), 1e-6 * std::max(1.0, at.slope)) << x;
    const double slope_change =
        obstructed_range(x + kStep, kRangeSigma_m).slope - obstructed_range(x - kStep, kRangeSigma_m).slope;
    EXPECT_NEAR(at.curvature, -slope_change / (2 * kStep), 1e-5) << x;
  }
}

TEST(ObstructedRange, FarTailsAreThoseOfANormalErrorAndOfNoInformation) {
  const ObstructedRange shorter = obstructed_range(-1000 * kRangeSigma_m, kRangeSigma_m);
  EXPECT_NEAR(shorter.slope * kRangeSigma_m, 1000, 0.01);
  EXPECT_NEAR(shorter.curvature * kRangeSigma_m * kRangeSigma_m, 1, 1e-5);
  const ObstructedRange longer = obstructed_range(1000 * kRangeSigma_m, kRangeSigma_m);
  EXPECT_EQ(longer.slope, 0);
  EXPECT_EQ(longer.curvature, 0);
}

}  // namespace
}  // namespace radioslam
