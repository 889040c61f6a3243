#include "radioslam/radio/fingerprints/similarity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "radioslam/base/parallel.hpp"
#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

constexpr SimilarityMeasure kMeasures[] = {SimilarityMeasure::kCosine,        SimilarityMeasure::kGaussian,
                                           SimilarityMeasure::kDetection,     SimilarityMeasure::kProduct,
                                           SimilarityMeasure::kGeometricMean, SimilarityMeasure::kSorensen};

FingerprintEntry entry(std::size_t access_point, float rss_dbm, float detection_rate) {
  return {AccessPointIndex(access_point), rss_dbm, detection_rate};
}

// Two shared access points that differ by 6 dB, and one unshared access point each.
const Fingerprint kA{{}, 4, {entry(0, -50, 1), entry(1, -60, 1), entry(2, -70, 0.5F)}};
const Fingerprint kB{{}, 4, {entry(1, -66, 0.75F), entry(2, -64, 1), entry(3, -80, 0.25F)}};

TEST(Similarity, Cosine) {
  // Shifted RSS: (50, 40, 30, 0) and (0, 34, 36, 20).
  EXPECT_NEAR(similarity(kA, kB, SimilarityMeasure::kCosine, {}), 2440 / std::sqrt(5000.0 * 2852), 1e-9);
}

TEST(Similarity, Gaussian) {
  // Square root of exp(-1/2) exp(-1/2), times two of four access points shared.
  EXPECT_NEAR(similarity(kA, kB, SimilarityMeasure::kGaussian, {}), std::exp(-0.5) / 2, 1e-9);
  EXPECT_NEAR(similarity(kA, kB, SimilarityMeasure::kGaussian, {.sigma_rss_db = 3}), std::exp(-2.0) / 2,
              1e-9);
}

TEST(Similarity, Detection) {
  // The unshared access points were detected in all and in a quarter of the scans.
  EXPECT_NEAR(similarity(kA, kB, SimilarityMeasure::kDetection, {}),
              std::exp(-0.5) / 2 * std::exp(-1.0 / 32) * std::exp(-1.0 / 512), 1e-9);
}

TEST(Similarity, Slide) {
  EXPECT_NEAR(similarity(kA, kB, SimilarityMeasure::kProduct, {}), std::exp(-1.0) / 4, 1e-9);
}

TEST(Similarity, MendedNeedsEnoughSharedAccessPoints) {
  EXPECT_NEAR(similarity(kA, kB, SimilarityMeasure::kGeometricMean, {.min_shared = 2}), std::exp(-0.5), 1e-9);
  EXPECT_EQ(similarity(kA, kB, SimilarityMeasure::kGeometricMean, {.min_shared = 3}), 0);
}

TEST(Similarity, Sorensen) {
  EXPECT_NEAR(similarity(kA, kB, SimilarityMeasure::kSorensen, {.sorensen_exponent = 1}), 128.0 / 210, 1e-6);
  EXPECT_NEAR(similarity(kA, kB, SimilarityMeasure::kSorensen, {.sorensen_exponent = 2}), 4112.0 / 7852,
              1e-6);
  const double e = std::exp(1.0);
  const auto g = [&](double shifted) { return std::pow(shifted, e); };
  EXPECT_NEAR(similarity(kA, kB, SimilarityMeasure::kSorensen, {}),
              2 * (g(34) + g(30)) / (g(50) + g(40) + g(30) + g(34) + g(36) + g(20)), 1e-6);
}

/// Random fingerprint of up to twelve of twenty access points.
Fingerprint random_fingerprint(Rng& rng) {
  Fingerprint fingerprint;
  fingerprint.scans = 4;
  for (std::size_t i = 0; i < 20; ++i) {
    if (rng.uniform() < 0.4) continue;
    fingerprint.entries.push_back(
        entry(i, static_cast<float>(rng.uniform(-95, -40)), 0.25F * static_cast<float>(1 + rng.below(4))));
  }
  return fingerprint;
}

std::vector<Fingerprint> random_fingerprints(std::uint64_t seed, int count) {
  Rng rng(seed);
  std::vector<Fingerprint> fingerprints;
  for (int i = 0; i < count; ++i) fingerprints.push_back(random_fingerprint(rng));
  return fingerprints;
}

TEST(Similarity, IsSymmetricAndBetweenNothingAndOne) {
  const auto all = random_fingerprints(1, 40);
  for (const SimilarityMeasure measure : kMeasures)
    for (const auto& a : all)
      for (const auto& b : all) {
        const double s = similarity(a, b, measure, {});
        EXPECT_GE(s, 0) << to_string(measure);
        EXPECT_LE(s, 1) << to_string(measure);
        EXPECT_NEAR(s, similarity(b, a, measure, {}), 1e-14) << to_string(measure);
      }
}

TEST(Similarity, OfAFingerprintWithItselfIsOneExceptForSlide) {
  for (const auto& f : random_fingerprints(2, 20)) {
    ASSERT_GE(f.entries.size(), 5U);
    for (const SimilarityMeasure measure : kMeasures) {
      const double heard = static_cast<double>(f.entries.size());
      EXPECT_NEAR(similarity(f, f, measure, {}), measure == SimilarityMeasure::kProduct ? 1 / heard : 1,
                  1e-12)
          << to_string(measure);
    }
  }
}

TEST(Similarity, WithoutASharedAccessPointIsNothing) {
  const Fingerprint other{{}, 1, {entry(4, -50, 1), entry(9, -60, 1)}};
  const Fingerprint empty{{}, 1, {}};
  for (const SimilarityMeasure measure : kMeasures) {
    EXPECT_EQ(similarity(kA, other, measure, {.min_shared = 1}), 0) << to_string(measure);
    EXPECT_EQ(similarity(kA, empty, measure, {.min_shared = 1}), 0) << to_string(measure);
    EXPECT_EQ(similarity(empty, empty, measure, {.min_shared = 1}), 0) << to_string(measure);
  }
}

TEST(Similarity, DetectionBecomesGaussianForAMildPenalty) {
  const auto all = random_fingerprints(3, 12);
  for (std::size_t i = 1; i < all.size(); ++i) {
    const auto detection = [&](double sigma) {
      return similarity(all[0], all[i], SimilarityMeasure::kDetection, {.sigma_detection = sigma});
    };
    const double gaussian = similarity(all[0], all[i], SimilarityMeasure::kGaussian, {});
    EXPECT_LT(detection(1), detection(4));
    EXPECT_LT(detection(4), gaussian);
    EXPECT_NEAR(detection(1000), gaussian, 1e-5 * gaussian);
  }
}

TEST(SimilarityTable, HoldsThePairwiseSimilarities) {
  const auto a = random_fingerprints(4, 23), b = random_fingerprints(5, 9);
  for (const SimilarityMeasure measure : kMeasures) {
    const auto table = similarity_table(a, b, measure, {});
    ASSERT_EQ(table.size(), a.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      ASSERT_EQ(table[i].size(), b.size());
      for (std::size_t j = 0; j < b.size(); ++j)
        EXPECT_EQ(table[i][j], static_cast<float>(similarity(a[i], b[j], measure, {}))) << to_string(measure);
    }
  }
}

TEST(SimilarityTable, IsTheSameForAnyNumberOfThreads) {
  const auto all = random_fingerprints(6, 60);
  for (const SimilarityMeasure measure : kMeasures) {
    set_thread_count(1);
    const auto alone = similarity_table(all, all, measure, {});
    set_thread_count(2);
    const auto together = similarity_table(all, all, measure, {});
    set_thread_count(0);
    EXPECT_EQ(alone, together) << to_string(measure);
  }
}

TEST(SimilarityMeasureName, LeadsBackToTheMeasure) {
  for (const SimilarityMeasure measure : kMeasures)
    EXPECT_EQ(similarity_measure(to_string(measure)), measure);
  EXPECT_FALSE(similarity_measure("Cosine").has_value());
  EXPECT_FALSE(similarity_measure("").has_value());
}

}  // namespace
}  // namespace radioslam
