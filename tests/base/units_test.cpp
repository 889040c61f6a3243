#include "radioslam/base/units.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

TEST(Units, TurnDegreesIntoRadiansAndBack) {
  EXPECT_EQ(radians(180), std::numbers::pi);
  EXPECT_EQ(degrees(std::numbers::pi), 180);
  EXPECT_NEAR(degrees(radians(37)), 37, 1e-13);
  EXPECT_NEAR(kRadiansPerDegree * kDegreesPerRadian, 1, 1e-15);
}

TEST(Units, TurnRatiosIntoDecibelsAndBack) {
  EXPECT_EQ(decibels(100), 20);
  EXPECT_NEAR(power_ratio(-3), 0.501, 1e-3);
  EXPECT_NEAR(decibels(power_ratio(-67)), -67, 1e-12);
}

TEST(Units, CountNanosecondsExactly) {
  EXPECT_EQ(kNanosecondsPerSecond, kMicrosecondsPerSecond * kNanosecondsPerMicrosecond);
  EXPECT_EQ(kNanosecondsPerSecond, 1000 * kNanosecondsPerMillisecond);
}

}  // namespace
}  // namespace radioslam
