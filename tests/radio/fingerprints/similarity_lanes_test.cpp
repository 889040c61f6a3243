#include "radioslam/radio/fingerprints/similarity_lanes.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/radio/fingerprints/similarity_join.hpp"
#include "radioslam/radio/fingerprints/similarity_sums.hpp"

namespace radioslam {
namespace {

constexpr SimilarityMeasure kLaneMeasures[] = {
    SimilarityMeasure::kCosine,  SimilarityMeasure::kGaussian,      SimilarityMeasure::kDetection,
    SimilarityMeasure::kProduct, SimilarityMeasure::kGeometricMean, SimilarityMeasure::kSorensen};
constexpr double kHeardByAll = 1, kHeardByHalf = 0.5;

/// Columns of values as in a block, and a fingerprint's own.
struct Columns {
  std::vector<float> values;
  std::vector<SharedColumn> met;
};

Columns draw_columns(std::size_t count, SimilarityMeasure measure, double heard, Rng& rng) {
  const bool is_sorensen = measure == SimilarityMeasure::kSorensen;
  const auto value = [&] {
    return static_cast<float>(rng.uniform(-105, -40)) + (is_sorensen ? 105.0F : 0.0F);
  };
  Columns columns;
  for (std::size_t k = 0; k < count * kLanes; ++k)
    columns.values.push_back(rng.uniform() < heard ? value() : is_sorensen ? 0.0F : kUndetectedValue);
  for (std::size_t c = 0; c < count; ++c) columns.met.push_back({&columns.values[c * kLanes], value()});
  return columns;
}

std::vector<SimilarityKernel> similarity_kernels(SimilarityMeasure measure) {
  std::vector<SimilarityKernel> all{similarity_kernel_sse2(measure)};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) all.push_back(similarity_kernel_avx2(measure));
#endif
  return all;
}

double term(float value, float own, SimilarityMeasure measure) {
  const double v = static_cast<double>(value), o = static_cast<double>(own);
  if (measure == SimilarityMeasure::kCosine) return shifted_rss_db(own) * shifted_rss_db(value);
  if (measure == SimilarityMeasure::kSorensen) return std::min(v, o);
  return (o - v) * (o - v);
}

TEST(SimilarityLanes, AddTheTermsOfASinglePairInItsOrder) {
  Rng rng(1);
  for (const auto measure : kLaneMeasures) {
    for (const std::size_t count : {0U, 1U, 7U, 60U}) {
      const Columns columns = draw_columns(count, measure, kHeardByHalf, rng);
      for (const SimilarityKernel& kernel : similarity_kernels(measure)) {
        LaneSums sums;
        kernel.sum(columns.met.data(), count, sums);
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
          double expected = 0;
          for (const SharedColumn& column : columns.met)
            if (column.values[lane] != kUndetectedValue)
              expected += term(column.values[lane], column.own, measure);
          ASSERT_EQ(sums.sum[lane], expected) << to_string(measure) << " lane " << lane;
        }
      }
    }
  }
}

/// Sums as similarity_of() takes them, for a lane that detects some columns only.
double lane_similarity(const LaneSums& sums, std::size_t lane, const FingerprintTotals& own,
                       const FingerprintTotals& its, SimilarityMeasure measure) {
  const int shared = static_cast<int>(sums.shared[lane]);
  return similarity_of({shared, sums.sum[lane], shared * 0.25, shared * 0.25}, own, its, measure,
                       {.min_shared = 3});
}

TEST(SimilarityLanes, NeverLoseALaneThatReaches) {
  Rng rng(2);
  std::size_t lost = 0, found = 0, asked = 0;
  for (int repeat = 0; repeat < 300; ++repeat) {
    const auto measure = kLaneMeasures[rng.below(6)];
    const std::size_t count = 1 + rng.below(12);
    const Columns columns = draw_columns(count, measure, kHeardByAll, rng);
    const double scale = rng.uniform(0.02, 1);  // reduces the differences of RSS
    for (const SimilarityKernel& kernel : similarity_kernels(measure)) {
      LaneSums sums;
      kernel.sum(columns.met.data(), count, sums);
      if (measure != SimilarityMeasure::kCosine && measure != SimilarityMeasure::kSorensen)
        for (double& sum : sums.sum) sum *= scale * scale * scale;
      LaneTotals lanes;
      const FingerprintTotals own{static_cast<int>(count) + 1, 0.25 * static_cast<double>(count + 1), 0.25};
      lanes.heard.fill(own.heard);
      lanes.total.fill(own.total);
      lanes.min_detection2.fill(0.25);
      LaneQuery query{rng.uniform(0.01, 1),
                      static_cast<double>(own.heard),
                      own.total,
                      0.25,
                      1.0 / 72,
                      measure == SimilarityMeasure::kDetection ? 1.0 / 32 : 0,
                      3};
      const LaneBits reaching = kernel.reaching(sums, lanes, query);
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const bool reaches = lane_similarity(sums, lane, own, own, measure) >= query.least * (1 + 1e-9);
        const bool is_found = (reaching >> lane & 1U) != 0;
        lost += reaches && !is_found ? 1 : 0;
        found += is_found ? 1 : 0;
        ++asked;
      }
    }
  }
  EXPECT_EQ(lost, 0U);
  EXPECT_GT(found, asked / 20);
  EXPECT_LT(found, asked / 2 + asked / 3);
}

TEST(SharedWeightBound, FollowsTheFormulas) {
  const Fingerprint four{{},
                         1,
                         {{AccessPointIndex(0), -70, 1},
                          {AccessPointIndex(1), -60, 1},
                          {AccessPointIndex(2), -80, 1},
                          {AccessPointIndex(5), -50, 1}}};
  const auto least = [&](SimilarityMeasure measure, double s) {
    return shared_weight_bound(four, s, measure, {}).least;
  };
  EXPECT_NEAR(least(SimilarityMeasure::kGaussian, 0.5), 2, 1e-6);
  EXPECT_NEAR(least(SimilarityMeasure::kGeometricMean, 0.5), 5, 1e-6);
  EXPECT_NEAR(least(SimilarityMeasure::kProduct, 0.2), 1, 1e-6);
  EXPECT_EQ(least(SimilarityMeasure::kProduct, 0.3), std::numeric_limits<double>::infinity());
  EXPECT_NEAR(least(SimilarityMeasure::kCosine, 0.5), 0.25 * (900 + 1600 + 400 + 2500), 1e-4);
}

TEST(SharedWeightBound, ThePrefixOmitsTheMostCommonOfTooLittleWeight) {
  const Fingerprint four{{},
                         1,
                         {{AccessPointIndex(0), -70, 1},
                          {AccessPointIndex(1), -60, 1},
                          {AccessPointIndex(2), -80, 1},
                          {AccessPointIndex(3), -50, 1}}};
  const std::vector<std::vector<std::uint32_t>> holders{{1, 2, 3}, {1}, {1, 2}, {1, 2, 3, 4}};
  const auto prefix = [&](double s) {
    return join_prefix(four, shared_weight_bound(four, s, SimilarityMeasure::kGaussian, {}), holders);
  };
  EXPECT_EQ(prefix(0.2), (std::vector<std::size_t>{1, 2, 0, 3}));
  EXPECT_EQ(prefix(0.5), (std::vector<std::size_t>{1, 2, 0}));  // two of four required
  EXPECT_EQ(prefix(1), (std::vector<std::size_t>{1}));
}

}  // namespace
}  // namespace radioslam
