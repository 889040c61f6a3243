#include "radioslam/radio/fingerprints/team_similarity.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

/// Fingerprints of a few of 30 access points each; every tenth is empty.
std::vector<Fingerprint> sparse_team(std::size_t count) {
  Rng rng(11);
  std::vector<Fingerprint> all(count);
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t a = 0; a < 30 && k % 10 != 0; ++a)
      if (rng.uniform() < 0.2)
        all[k].entries.push_back({AccessPointIndex(a), static_cast<float>(rng.uniform(-95, -40)), 1});
  return all;
}

TEST(TeamSimilarity, VisitsThePairsOfTheTableInItsOrder) {
  // More rows than are joined at once.
  const auto fingerprints = sparse_team(64 * SimilarityJoin::kRowsTogether + 7);
  const auto table = similarity_table(fingerprints, fingerprints, SimilarityMeasure::kSorensen, {});
  const TeamSimilarity joined(fingerprints, SimilarityMeasure::kSorensen, {}), given(table);
  ASSERT_EQ(joined.size(), given.size());
  for (const double minimum : {kAnySimilarity, 0.3, 0.8}) {
    std::vector<SimilarPair> a, b, expected;
    joined.for_each_pair(minimum, [&](const SimilarPair& pair) { a.push_back(pair); });
    given.for_each_pair(minimum, [&](const SimilarPair& pair) { b.push_back(pair); });
    for (std::uint32_t i = 0; i < table.size(); ++i)
      for (std::uint32_t j = i + 1; j < table.size(); ++j)
        if (static_cast<double>(table[i][j]) >= minimum) expected.push_back({i, j, table[i][j]});
    ASSERT_GT(expected.size(), 100U);
    EXPECT_TRUE(a == expected) << minimum;
    EXPECT_TRUE(b == expected) << minimum;
  }
}

/// A team's fingerprints as they come, in any batches, with access points numbered among those heard so far.
class ComingFingerprints {
 public:
  ComingFingerprints(std::size_t robots, std::size_t each, std::uint64_t seed) : rng_(seed), known_(robots) {
    const auto all = sparse_team(robots * each);
    for (std::size_t r = 0; r < robots; ++r)
      heard_.emplace_back(all.begin() + static_cast<std::ptrdiff_t>(r * each),
                          all.begin() + static_cast<std::ptrdiff_t>((r + 1) * each));
  }

  bool has_more() const { return known_ < std::vector<std::size_t>(known_.size(), heard_[0].size()); }
  /// Some more of every robot; what is new among those known, beside the last of each robot, which changes.
  EarlierNumbers take_some() {
    EarlierNumbers earlier;
    std::size_t before = 0;
    for (std::size_t r = 0; r < known_.size(); ++r) {
      const std::size_t had = known_[r];
      known_[r] = std::min(heard_[r].size(), had + rng_.below(14));
      for (std::size_t k = 0; k < known_[r]; ++k)
        earlier.push_back(k + 1 < had ? std::optional(before + k) : std::nullopt);
      before += had;
    }
    return earlier;
  }

  std::vector<Fingerprint> known() const {
    std::set<AccessPointIndex> names;
    std::vector<Fingerprint> all;
    for (std::size_t r = 0; r < known_.size(); ++r)
      for (std::size_t k = 0; k < known_[r]; ++k) {
        all.push_back(heard_[r][k]);
        if (k + 1 == known_[r] && !all.back().entries.empty()) all.back().entries.pop_back();
        for (const FingerprintEntry& entry : all.back().entries) names.insert(entry.access_point);
      }
    for (Fingerprint& of : all)
      for (FingerprintEntry& entry : of.entries)
        entry.access_point = AccessPointIndex(
            static_cast<std::size_t>(std::distance(names.begin(), names.find(entry.access_point))));
    return all;
  }

 private:
  Rng rng_;
  std::vector<std::size_t> known_;  ///< of each robot
  std::vector<std::vector<Fingerprint>> heard_;
};

std::vector<SimilarPair> pairs_of(const TeamSimilarity& team, double minimum) {
  std::vector<SimilarPair> pairs;
  team.for_each_pair(minimum, [&](const SimilarPair& pair) { pairs.push_back(pair); });
  return pairs;
}

TEST(TeamSimilarity, GrowsInAnyBatchesAsJoinedFromNothing) {
  const SimilarityParams params{.min_shared = 2};
  for (const auto measure :
       {SimilarityMeasure::kCosine, SimilarityMeasure::kGaussian, SimilarityMeasure::kDetection,
        SimilarityMeasure::kProduct, SimilarityMeasure::kGeometricMean, SimilarityMeasure::kSorensen})
    for (std::uint64_t split = 1; split <= 3; ++split) {
      ComingFingerprints coming(3, 70, split);
      TeamSimilarity team = TeamSimilarity({}, measure, params).joined(0.02);
      while (coming.has_more()) {
        const EarlierNumbers earlier = coming.take_some();
        team = team.grown(coming.known(), earlier);
        const TeamSimilarity from_nothing(coming.known(), measure, params);
        ASSERT_EQ(team.size(), from_nothing.size());
        for (const double minimum : {kAnySimilarity, 0.02, 0.3, 0.7})
          ASSERT_TRUE(pairs_of(team, minimum) == pairs_of(from_nothing, minimum))
              << to_string(measure) << " " << split << " " << minimum;
      }
      EXPECT_GT(pairs_of(team, 0.02).size(), 1000U) << to_string(measure);
    }
}

/// What was compared before is taken as it was.
TEST(TeamSimilarity, ComparesOnlyWhatIsNew) {
  const auto some = sparse_team(40);
  auto more = sparse_team(60);
  const TeamSimilarity before = TeamSimilarity(some, SimilarityMeasure::kSorensen, {}).joined(0.1);
  EarlierNumbers earlier(60);
  for (std::size_t k = 0; k < 40; ++k) {
    earlier[k] = k;
    more[k].entries.clear();  // claimed to be as before
  }
  std::vector<SimilarPair> old;
  for (const SimilarPair& pair : pairs_of(before.grown(more, earlier), 0.1))
    if (pair.j < 40) old.push_back(pair);
  ASSERT_GT(old.size(), 100U);
  EXPECT_TRUE(old == pairs_of(before, 0.1));
}

TEST(TeamSimilarity, OfTwoIsSymmetric) {
  const auto fingerprints = sparse_team(40);
  for (const auto measure : {SimilarityMeasure::kCosine, SimilarityMeasure::kProduct}) {
    const TeamSimilarity team(fingerprints, measure, {});
    for (std::size_t i = 0; i < fingerprints.size(); ++i)
      for (std::size_t j = i; j < fingerprints.size(); ++j) {
        const auto expected = static_cast<float>(similarity(fingerprints[i], fingerprints[j], measure, {}));
        EXPECT_EQ(team.of(i, j), expected);
        EXPECT_EQ(team.of(j, i), expected);
      }
  }
}

TEST(TeamSimilarity, RowsHaveTheirOwnPairsOnly) {
  const TeamSimilarity team(sparse_team(100), SimilarityMeasure::kSorensen, {});
  std::int64_t last = -1;
  team.for_each_row(0.2, [&](std::span<const SimilarPair> row) {
    ASSERT_FALSE(row.empty());
    EXPECT_GT(row.front().i, last);
    last = row.front().i;
    for (const SimilarPair& pair : row) EXPECT_EQ(pair.i, last);
  });
  EXPECT_GT(last, 0);
}

TEST(TeamSimilarity, OfNobodyHasNoPairs) {
  TeamSimilarity().for_each_pair(0.1, [](const SimilarPair&) { ADD_FAILURE(); });
  EXPECT_EQ(TeamSimilarity().size(), 0U);
}

}  // namespace
}  // namespace radioslam
