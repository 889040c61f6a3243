#include <gtest/gtest.h>

#include <cmath>

#include "radioslam/base/random.hpp"
#include "radioslam/radio/fingerprints/distance_model.hpp"

namespace radioslam {
namespace {

TEST(MedianModel, FindsTheDistanceAmongOutliers) {
  for (const double length : {6.0, 14.0}) {
    Rng rng(3);
    std::vector<DistanceSample> samples;
    for (int i = 0; i < 4000; ++i) {
      const double distance = rng.uniform(0, 3 * length);
      const double s = std::exp(-distance / (length * std::exp(rng.normal(0, 0.1))));
      samples.push_back({s, rng.uniform() < 0.15 ? rng.uniform(0, 100) : distance});
    }
    const auto model = MedianModel::fit(samples, 30);
    ASSERT_TRUE(model);
    for (const double s : {0.2, 0.4, 0.7})
      EXPECT_NEAR(model->distance_m(s), -length * std::log(s), 0.15 * length) << s;
  }
}

TEST(MedianModel, NeverRisesWithSimilarity) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Rng rng(seed);
    std::vector<DistanceSample> samples;
    for (int i = 0; i < 500; ++i) {
      const double s = rng.uniform();
      samples.push_back({s, 30 * (1 - s) + rng.uniform(0, 40)});
    }
    const auto model = MedianModel::fit(samples, 10);
    ASSERT_TRUE(model);
    for (double s = 0; s < 1; s += 0.01) EXPECT_GE(model->distance_m(s), model->distance_m(s + 0.01));
  }
}

TEST(MedianModel, RefusesTooFewSamples) {
  const std::vector<DistanceSample> samples(29, {0.5, 10});
  EXPECT_FALSE(MedianModel::fit(samples, 30));
  EXPECT_FALSE(MedianModel::fit({}, 1));
  ASSERT_TRUE(MedianModel::fit(samples, 29));
  for (const double s : {0.0, 0.5, 1.0}) EXPECT_EQ(MedianModel::fit(samples, 29)->distance_m(s), 10);
}

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
