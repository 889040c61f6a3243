#include "radioslam/rendezvous/published_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace radioslam {
namespace {

// Raw poses and measurements have noise of their own: 2 sigma^2 per component, two of position and one of
// rotation, by Wang et al., eq. 3: omega_t^2 * 4 sigma_t^2 + omega_r^2 * 2 sigma_r^2 for small angles.
TEST(PublishedError, GrowsWithEveryStepByTheNoiseOfBothEnds) {
  constexpr double kOmegaT = 2, kOmegaR = 3, kSigmaT = 0.2, kSigmaR = 0.05;
  constexpr int kSteps = 20000;
  PublishedError error(kOmegaT, kOmegaR, 1, SE2());
  for (int k = 0; k < kSteps; ++k) error.move(SE2({2, 0}, 0.1), kSigmaT, kSigmaR);
  const double expected =
      kOmegaT * kOmegaT * 4 * kSigmaT * kSigmaT + kOmegaR * kOmegaR * 2 * kSigmaR * kSigmaR;
  EXPECT_NEAR(error.value() / kSteps, expected, 0.03 * expected);
}

TEST(PublishedError, AnObservationAddsItsDisagreementWithWhatTheOtherSays) {
  PublishedError error(1, 1, 1, SE2());
  error.see(SE2({2, 0}, 0), std::nullopt);
  EXPECT_EQ(error.value(), 0);
  error.see(SE2({2, 0}, 0), SE2({2, 3}, M_PI / 2));
  EXPECT_NEAR(error.value(), 9 + 2, 1e-12);  // |R_a - R_b|_F^2 / 2 = 2 at a right angle
}

TEST(PublishedError, IsWhatTheOptimumLeaves) {
  RobotEstimate team("a", 0, SE2(), {});
  PublishedError error(1, 1, 1, SE2());
  for (int k = 0; k < 10; ++k) {
    team.move(k + 1, SE2({1, 0}, 0.2), 0.1, 0.1);
    error.move(SE2({1, 0}, 0.2), 0.1, 0.1);
  }
  EXPECT_GT(error.value(), 0);
  error.optimized(team);  // odometry alone contradicts nothing
  EXPECT_NEAR(error.value(), 0, 1e-9);
}

}  // namespace
}  // namespace radioslam
