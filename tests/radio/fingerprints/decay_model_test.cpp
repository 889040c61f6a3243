#include <gtest/gtest.h>

#include <cmath>

#include "radioslam/base/random.hpp"
#include "radioslam/radio/fingerprints/distance_model.hpp"

namespace radioslam {
namespace {

TEST(FitDecay, FindsTheLengthAmongOutliers) {
  for (const double length : {6.0, 14.0}) {
    Rng rng(3);
    std::vector<DistanceSample> samples;
    for (int i = 0; i < 2000; ++i) {
      const double distance = rng.uniform(2, 3 * length);
      const double s = std::exp(-distance / (length * std::exp(rng.normal(0, 0.2))));
      samples.push_back({rng.uniform() < 0.15 ? rng.uniform() : s, distance});
    }
    const auto model = fit_decay(samples, 30);
    ASSERT_TRUE(model);
    EXPECT_NEAR(model->length_m, length, 0.07 * length);
  }
}

TEST(FitDecay, RefusesTooFewSamples) {
  const std::vector<DistanceSample> samples(29, {0.5, 10});
  EXPECT_FALSE(fit_decay(samples, 30));
  EXPECT_TRUE(fit_decay(samples, 29));
}

TEST(FitDecay, DoesNotCountUninformativeSamples) {
  std::vector<DistanceSample> samples(20, {std::exp(-1.0), 10});
  for (int i = 0; i < 20; ++i) {
    samples.push_back({0.95, 20});  // nearly identical
    samples.push_back({0.01, 20});  // hardly any overlap
    samples.push_back({0.5, 1});    // too close
    samples.push_back({0, 50});
  }
  EXPECT_FALSE(fit_decay(samples, 21));
  ASSERT_TRUE(fit_decay(samples, 20));
  EXPECT_NEAR(fit_decay(samples, 20)->length_m, 10, 1e-6);
}

TEST(DecayModel, DistancesFollowTheLogarithmDownToAMetre) {
  const DecayModel model{12};
  EXPECT_NEAR(model.distance_m(std::exp(-1.0)), 12, 1e-12);
  EXPECT_NEAR(model.distance_m(std::exp(-2.5)), 30, 1e-12);
  EXPECT_EQ(model.distance_m(1), 1);
  EXPECT_EQ(model.distance_m(0.99), 1);
}

}  // namespace
}  // namespace radioslam
