#include "radioslam/radio/fingerprints/distance_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

DistanceModelParams plain() {
  DistanceModelParams params;
  params.bin_width = 0.1;
  params.min_samples = 3;
  params.even_distances = false;
  return params;
}

TEST(DistanceModel, PredictsMeanAndSpreadOfItsWindow) {
  const DistanceModel model({{0.56, 50}, {0.52, 9}, {0.48, 2}, {0.5, 4}, {0.4, 100}}, plain());
  const auto predicted = model.predict(0.5);
  ASSERT_TRUE(predicted);
  EXPECT_EQ(predicted->samples, 3);
  EXPECT_NEAR(predicted->mean_m, 5, 1e-12);
  EXPECT_NEAR(predicted->sigma_m, std::sqrt(26.0 / 3), 1e-12);
}

TEST(DistanceModel, ItsWindowSlides) {
  const DistanceModel model({{0.1, 30}, {0.2, 20}, {0.25, 16}, {0.29, 12}, {0.4, 8}}, plain());
  EXPECT_FALSE(model.predict(0.2));
  ASSERT_TRUE(model.predict(0.245));
  EXPECT_NEAR(model.predict(0.245)->mean_m, 16, 1e-12);
}

TEST(DistanceModel, PredictsNothingFromTooFewSamples) {
  std::vector<DistanceSample> samples(29, {0.5, 3});
  DistanceModelParams params;
  ASSERT_EQ(params.min_samples, 30);
  EXPECT_FALSE(DistanceModel(samples, params).predict(0.5));
  samples.push_back({0.5, 3});
  EXPECT_TRUE(DistanceModel(samples, params).predict(0.5));
  EXPECT_FALSE(DistanceModel(samples, params).predict(0.6));
  EXPECT_FALSE(DistanceModel({}, params).predict(0.5));
}

TEST(DistanceModel, KnowsItsSmallestPrediction) {
  const DistanceModel model({{0.2, 9}, {0.21, 9}, {0.22, 9}, {0.8, 3}, {0.81, 3}, {0.82, 3}, {0.99, 1}},
                            plain());
  ASSERT_TRUE(model.smallest_distance_m());
  EXPECT_NEAR(*model.smallest_distance_m(), 3, 1e-9);
  EXPECT_FALSE(DistanceModel({}, plain()).smallest_distance_m());
}

TEST(DistanceModel, UninformativeSimilaritiesHaveNoSmallestPrediction) {
  std::vector<DistanceSample> samples;
  for (int k = 0; k < 400; ++k) samples.push_back({1, 0.1 * k});  // identical at any distance
  ASSERT_TRUE(DistanceModel(samples, plain()).predict(1));
  EXPECT_FALSE(DistanceModel(samples, plain()).smallest_distance_m());
}

TEST(DistanceModel, KnowsTheLeastSimilarityThatPredictsSoNear) {
  const DistanceModel model({{0.2, 9}, {0.21, 9}, {0.22, 9}, {0.8, 3}, {0.81, 3}, {0.82, 3}}, plain());
  const double least = *model.min_similarity_below(4);
  EXPECT_NEAR(least, 0.77, 0.002);  // its window contains all three
  EXPECT_FALSE(model.predict(least - 0.002));
  EXPECT_NEAR(*model.min_similarity_below(10), 0.17, 0.002);
  EXPECT_FALSE(model.min_similarity_below(3));
}

/// Samples of s = exp(-d / 15 m + normal) at distances in metres drawn by `draw`.
std::vector<DistanceSample> draw_samples(const std::function<double(double)>& draw) {
  Rng rng(7);
  std::vector<DistanceSample> samples;
  for (int i = 0; i < 200000; ++i) {
    const double distance = draw(rng.uniform());
    samples.push_back({std::min(1.0, std::exp(-distance / 15 + rng.normal(0, 0.8))), distance});
  }
  return samples;
}

TEST(DistanceModel, EvenDistancesForgetHowCommonTheyWereInTraining) {
  const auto even = draw_samples([](double u) { return 60 * u; });
  const auto mostly_near = draw_samples([](double u) { return 60 * u * u; });
  DistanceModelParams with, without;
  without.even_distances = false;
  for (const double s : {0.2, 0.3, 0.5}) {
    const auto a = *DistanceModel(even, with).predict(s), b = *DistanceModel(mostly_near, with).predict(s);
    EXPECT_NEAR(a.mean_m / b.mean_m, 1, 0.05) << s;
    EXPECT_NEAR(a.sigma_m / b.sigma_m, 1, 0.08) << s;
    const auto c = *DistanceModel(mostly_near, without).predict(s);
    EXPECT_GT(a.mean_m / c.mean_m, 1.1) << s;
  }
}

/// Mean and mean square of exp(-(d - peak)^2 / 2 spread^2) over d >= 0, by the midpoint rule.
struct Integrated {
  double mean = 0, mean_square = 0;
};

Integrated integrate(const PredictedDistance& p) {
  constexpr int kCells = 20000;
  const double begin = std::max(0.0, p.peak_m - 10 * p.spread_m), end = p.peak_m + 10 * p.spread_m;
  double weight = 0, first = 0, second = 0;
  for (int i = 0; i < kCells; ++i) {
    const double d = begin + (end - begin) * (i + 0.5) / kCells;
    const double w = std::exp(-std::pow((d - p.peak_m) / p.spread_m, 2) / 2);
    weight += w;
    first += w * d;
    second += w * d * d;
  }
  return {first / weight, second / weight};
}

TEST(CutOffAtZero, HasTheRequestedMoments) {
  const double cases[][2] = {{10, 0.5}, {10, 3}, {10, 5}, {10, 7}, {4, 3}, {0.3, 0.2}};
  for (const auto& [mean, sigma] : cases) {
    const auto p = truncated_at_zero(mean, sigma, 17);
    const auto moments = integrate(p);
    EXPECT_NEAR(moments.mean, mean, 1e-4 * mean) << mean << " " << sigma;
    EXPECT_NEAR(std::sqrt(moments.mean_square - moments.mean * moments.mean), sigma, 1e-3 * sigma);
    EXPECT_GT(p.peak_m, 0);
    EXPECT_EQ(p.mean_m, mean);
    EXPECT_EQ(p.sigma_m, sigma);
    EXPECT_EQ(p.samples, 17);
  }
}

TEST(CutOffAtZero, PeaksAtZeroWhenWiderThanHalfAGaussian) {
  for (const double sigma : {3.1, 4.0, 9.0}) {
    const auto p = truncated_at_zero(4, sigma, 1);
    EXPECT_EQ(p.peak_m, 0);
    EXPECT_NEAR(integrate(p).mean_square, 16 + sigma * sigma, 1e-3 * sigma * sigma);
  }
}

TEST(CutOffAtZero, StaysFiniteWithoutSpread) {
  const auto sharp = truncated_at_zero(4, 0, 1);
  EXPECT_NEAR(sharp.peak_m, 4, 1e-3);
  EXPECT_LT(sharp.spread_m, 1e-3);
  const auto nowhere = truncated_at_zero(0, 0, 1);
  EXPECT_EQ(nowhere.peak_m, 0);
  EXPECT_EQ(nowhere.spread_m, 0);
}

}  // namespace
}  // namespace radioslam
