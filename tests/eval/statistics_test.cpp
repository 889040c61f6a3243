#include <gtest/gtest.h>

#include <cmath>

#include "radioslam/eval/metrics.hpp"

namespace radioslam {
namespace {

TEST(Quantile, IsLinearBetweenNeighbours) {
  const std::vector<double> sorted{1, 2, 4, 8, 16};
  EXPECT_DOUBLE_EQ(quantile(sorted, 0), 1);
  EXPECT_DOUBLE_EQ(quantile(sorted, 0.5), 4);
  EXPECT_DOUBLE_EQ(quantile(sorted, 0.9), 12.8);  // position 3.6: 8 + 0.6 * 8
  EXPECT_DOUBLE_EQ(quantile(sorted, 1), 16);
  EXPECT_DOUBLE_EQ(quantile({7}, 0.9), 7);
}

TEST(SummariseErrors, GivesTheTextbookFigures) {
  const auto statistics = summarise_errors({4, 1, 3, 2});
  ASSERT_TRUE(statistics);
  EXPECT_DOUBLE_EQ(statistics->mean_m, 2.5);
  EXPECT_DOUBLE_EQ(statistics->median_m, 2.5);
  EXPECT_DOUBLE_EQ(statistics->rmse_m, std::sqrt(7.5));
  EXPECT_DOUBLE_EQ(statistics->p90_m, 3.7);
  EXPECT_EQ(statistics->count, 4U);
}

TEST(SummariseErrors, HasNothingToSayAboutNothing) { EXPECT_FALSE(summarise_errors({})); }

}  // namespace
}  // namespace radioslam
