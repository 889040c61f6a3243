#include "radioslam/radio/fingerprints/team_similarity.hpp"

#include <gtest/gtest.h>

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
