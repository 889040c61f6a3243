#include "radioslam/rendezvous/angle_evidence.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

constexpr double kSigma = 0.148;  // 8.5 degrees

std::vector<ArrivalPath> arrival(double azimuth_rad) { return {{azimuth_rad, kSigma, 0}}; }

TEST(AngleEvidence, SpeaksForAPoseInTheDirectionOfArrivalAndAgainstOneElsewhere) {
  const SE2 ahead({2, 0}, 0);
  EXPECT_LT(check_angles({ahead, 0.2, 0}, {arrival(0.05)}, {}).log_odds, -1);
  EXPECT_GT(check_angles({ahead, 0.2, 0}, {arrival(1.5)}, {}).log_odds, 2);
  EXPECT_EQ(check_angles({ahead, 0.2, 0}, {}, {}).log_odds, 0);
}

TEST(AngleEvidence, AReflectionBesideTheDirectPathDoesNotSpeakAgainstAPose) {
  const std::vector<ArrivalPath> paths{{0.02, kSigma, 0}, {2.0, kSigma, -8}};
  EXPECT_LT(check_angles({SE2({2, 0}, 0), 0.2, 0}, {paths}, {}).log_odds, -0.5);
}

// An e-value: of correct poses, the mean of exp(log odds) is at most one, whatever is believed afterwards.
TEST(AngleEvidence, IsNotAgainstCorrectPosesOnAverage) {
  Rng rng(3);
  double sum = 0;
  constexpr int kDraws = 20000;
  for (int k = 0; k < kDraws; ++k) {
    const SE2 seen({2 + rng.normal(0, 0.2), rng.normal(0, 0.2)}, 0);
    sum += std::exp(check_angles({seen, 0.2, 0}, {arrival(rng.normal(0, kSigma))}, {0.95, 0.1}).log_odds);
  }
  EXPECT_LT(sum / kDraws, 1.05);
}

TEST(AngleEvidence, PublishedScaleKeepsWhatIsWithinTheThreshold) {
  EXPECT_EQ(check_angles({SE2({2, 0}, 0), 0.2, 0}, {arrival(0.1)}, {}).scale, 1);
  const double error = 0.3;
  EXPECT_NEAR(check_angles({SE2({2, 0}, 0), 0.2, 0}, {arrival(error)}, {}).scale,
              std::exp(-0.5 * error * error / (kSigma * kSigma)), 1e-9);
}

}  // namespace
}  // namespace radioslam
