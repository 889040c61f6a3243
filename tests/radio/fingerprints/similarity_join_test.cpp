#include "radioslam/radio/fingerprints/similarity_join.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "radioslam/base/parallel.hpp"
#include "radioslam/base/random.hpp"

namespace radioslam {

void PrintTo(const SimilarPair& pair, std::ostream* out) {
  *out << pair.i << "," << pair.j << "," << pair.similarity;
}

namespace {

constexpr SimilarityMeasure kAllMeasures[] = {
    SimilarityMeasure::kCosine,  SimilarityMeasure::kGaussian,      SimilarityMeasure::kDetection,
    SimilarityMeasure::kProduct, SimilarityMeasure::kGeometricMean, SimilarityMeasure::kSorensen};
constexpr double kMinima[] = {1e-46, 1e-30, 0.05, 0.3, 0.5, 0.8, 0.99, 1};

using Pairs = std::vector<SimilarPair>;

/// Distribution of a recording's fingerprints.
struct Distribution {
  std::size_t access_points = 20;
  double heard = 0.5;     ///< detection probability of the most common access points
  double spread_db = 10;  ///< of the RSS around the access point's mean
  double step_db = 0;     ///< quantisation of the RSS; 0: none
  double empty = 0.05;    ///< fraction of fingerprints without readings
  double repeated = 0.1;  ///< fraction that repeats the previous one
  double first_dbm = -95, last_dbm = -45;
};

Fingerprint draw(const Distribution& distribution, Rng& rng) {
  Fingerprint fingerprint{{}, 4, {}};
  if (rng.uniform() < distribution.empty) return fingerprint;
  for (std::size_t k = 0; k < distribution.access_points; ++k) {
    // Access points are detected less often the larger their index.
    const double rarity = static_cast<double>(k) / static_cast<double>(distribution.access_points);
    if (rng.uniform() > distribution.heard * (1 - 0.9 * rarity)) continue;
    double rss_dbm =
        rng.uniform(distribution.first_dbm, distribution.last_dbm) + rng.normal(0, distribution.spread_db);
    if (distribution.step_db > 0) rss_dbm = std::round(rss_dbm / distribution.step_db) * distribution.step_db;
    const auto heard = static_cast<float>(1 + rng.below(4));
    fingerprint.entries.push_back({AccessPointIndex(k), static_cast<float>(rss_dbm), heard / 4});
  }
  return fingerprint;
}

std::vector<Fingerprint> draw(const Distribution& distribution, std::size_t count, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Fingerprint> all;
  while (all.size() < count) {
    const bool repeats = !all.empty() && rng.uniform() < distribution.repeated;
    all.push_back(repeats ? all.back() : draw(distribution, rng));
  }
  return all;
}

/// Sparse, dense, quantised, continuous, all equal, around -100 dBm, one access point only.
std::vector<Distribution> airs() {
  return {{},
          {.heard = 1, .spread_db = 2, .step_db = 1, .empty = 0},
          {.access_points = 300, .heard = 0.1},
          {.access_points = 70, .heard = 0.6, .spread_db = 0, .step_db = 5},
          {.access_points = 12, .spread_db = 0, .empty = 0.3, .first_dbm = -60, .last_dbm = -60},
          {.access_points = 12, .spread_db = 1, .step_db = 0.5, .first_dbm = -102, .last_dbm = -98},
          {.access_points = 1, .heard = 0.7, .step_db = 10}};
}

std::vector<SimilarityParams> parameter_sets() {
  return {{},
          {.sigma_rss_db = 0.7, .sigma_detection = 0.3, .sorensen_exponent = 1, .min_shared = 1},
          {.sigma_rss_db = 60, .sigma_detection = 900, .sorensen_exponent = 9.5, .min_shared = 12}};
}

/// Pairs by the table of all pairs.
class AllPairs {
 public:
  AllPairs(const std::vector<Fingerprint>& a, const std::vector<Fingerprint>& b, SimilarityMeasure measure,
           const SimilarityParams& params)
      : is_one_recording_(&a == &b), table_(similarity_table(a, b, measure, params)) {}

  Pairs reaching(double minimum) const {
    Pairs pairs;
    for (std::uint32_t i = 0; i < table_.size(); ++i)
      for (std::uint32_t j = is_one_recording_ ? i + 1 : 0; j < table_[i].size(); ++j)
        if (static_cast<double>(table_[i][j]) >= minimum) pairs.push_back({i, j, table_[i][j]});
    return pairs;
  }

 private:
  bool is_one_recording_;
  std::vector<std::vector<float>> table_;
};

Pairs by_all_pairs(const std::vector<Fingerprint>& a, const std::vector<Fingerprint>& b,
                   const SimilarityQuery& query) {
  return AllPairs(a, b, query.measure, query.params).reaching(query.minimum);
}

void expect_same_as_all_pairs(const std::vector<Fingerprint>& a, const std::vector<Fingerprint>& b,
                              SimilarityMeasure measure, const SimilarityParams& params) {
  const AllPairs within(a, a, measure, params), between(a, b, measure, params);
  for (const double minimum : kMinima) {
    const SimilarityQuery query{measure, params, minimum};
    ASSERT_EQ(SimilarityJoin::within(a, query).pairs(), within.reaching(minimum))
        << to_string(measure) << " " << minimum;
    ASSERT_EQ(SimilarityJoin::between(a, b, query).pairs(), between.reaching(minimum))
        << to_string(measure) << " " << minimum;
  }
}

TEST(SimilarityJoin, GivesThePairsAndTheFloatsOfAllPairs) {
  std::uint64_t seed = 0;
  for (const Distribution& distribution : airs()) {
    const auto a = draw(distribution, 70, ++seed), b = draw(distribution, 41, ++seed);
    for (const auto& params : parameter_sets())
      for (const auto measure : kAllMeasures) expect_same_as_all_pairs(a, b, measure, params);
  }
}

TEST(SimilarityJoin, TakesAMinimumThatIsTheSimilarityOfAPair) {
  const auto all = draw({.access_points = 15, .step_db = 3}, 60, 17);
  for (const auto measure : kAllMeasures) {
    const auto some = SimilarityJoin::within(all, {measure, {}, 0.1}).pairs();
    for (std::size_t k = 0; k < some.size(); k += 1 + some.size() / 20) {
      const double exactly = static_cast<double>(some[k].similarity);
      for (const double minimum : {exactly, std::nextafter(exactly, 2.0)}) {
        const SimilarityQuery query{measure, {}, minimum};
        ASSERT_EQ(SimilarityJoin::within(all, query).pairs(), by_all_pairs(all, all, query))
            << to_string(measure) << " " << minimum;
      }
    }
  }
}

TEST(SimilarityJoin, WithoutAMinimumGivesEveryPair) {
  const auto a = draw({.access_points = 60, .heard = 0.1}, 50, 3), b = draw({.access_points = 90}, 20, 4);
  for (const auto measure : kAllMeasures) {
    const SimilarityQuery query{measure, {}, 0};
    const auto within = SimilarityJoin::within(a, query).pairs();
    EXPECT_EQ(within.size(), 50U * 49 / 2);
    EXPECT_EQ(within, by_all_pairs(a, a, query)) << to_string(measure);
    EXPECT_EQ(SimilarityJoin::between(a, b, query).pairs(), by_all_pairs(a, b, query)) << to_string(measure);
  }
}

TEST(SimilarityJoin, GoesThroughRecordingsOfSeveralSlabs) {
  const Distribution distribution{.access_points = 40, .heard = 0.2};
  const auto few = draw(distribution, 12, 5), many = draw(distribution, 2 * kSlabLanes + 77, 6);
  for (const auto measure : {SimilarityMeasure::kDetection, SimilarityMeasure::kSorensen}) {
    const SimilarityQuery query{measure, {}, 0.4};
    EXPECT_EQ(SimilarityJoin::between(few, many, query).pairs(), by_all_pairs(few, many, query));
  }
}

TEST(SimilarityJoin, GivesTheSameForAnyRowsAskedForAndAnyNumberOfThreads) {
  const auto all = draw({}, 150, 7);
  for (const auto measure : kAllMeasures) {
    set_thread_count(1);
    const auto join = SimilarityJoin::within(all, {measure, {}, 0.2});
    const Pairs alone = join.pairs();
    set_thread_count(3);
    EXPECT_EQ(SimilarityJoin::within(all, {measure, {}, 0.2}).pairs(), alone);
    set_thread_count(0);
    Pairs piecewise;
    for (std::size_t begin = 0; begin < all.size(); begin += 37)
      for (const auto& pair : join.pairs_of(begin, std::min(all.size(), begin + 37)))
        piecewise.push_back(pair);
    EXPECT_EQ(piecewise, alone);
  }
}

TEST(SimilarityJoin, TakesRecordingsWithoutFingerprintsOrWithoutAccessPoints) {
  const std::vector<Fingerprint> none, silent(3, Fingerprint{{}, 1, {}});
  const auto some = draw({}, 5, 8);
  for (const auto measure : kAllMeasures) {
    const SimilarityQuery query{measure, {}, 0.1};
    EXPECT_TRUE(SimilarityJoin::within(none, query).pairs().empty());
    EXPECT_TRUE(SimilarityJoin::between(none, some, query).pairs().empty());
    EXPECT_TRUE(SimilarityJoin::between(some, none, query).pairs().empty());
    EXPECT_TRUE(SimilarityJoin::within(silent, query).pairs().empty());
    EXPECT_TRUE(SimilarityJoin::between(silent, some, query).pairs().empty());
    EXPECT_EQ(SimilarityJoin::within(silent, {measure, {}, 0}).pairs().size(), 3U);
  }
}

TEST(SimilarityJoin, VisitsFewBlocksWherePlacesAreFarApart) {
  // Twenty places with ten access points each, visited in turn: a block holds one place.
  std::vector<Fingerprint> all;
  for (std::size_t k = 0; k < 20 * kLanes; ++k) {
    all.push_back({{}, 1, {}});
    for (std::size_t ap = 0; ap < 10; ++ap)
      all.back().entries.push_back({AccessPointIndex(k % 20 * 10 + ap), -60, 1});
  }
  const auto blocks = fingerprint_blocks(all, 200, SimilarityMeasure::kGaussian, {});
  ASSERT_EQ(blocks.blocks.size(), 20U);
  for (const auto& block : blocks.blocks) EXPECT_EQ(block.access_points.size(), 10U);
  for (const auto& holders : blocks.holders) EXPECT_EQ(holders.size(), 1U);
}

}  // namespace
}  // namespace radioslam
