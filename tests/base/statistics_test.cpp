#include "radioslam/base/statistics.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

TEST(Medians, AgreeForAnOddNumber) {
  const std::vector<double> values{5, -1, 3};
  EXPECT_EQ(upper_median(values), 3);
  EXPECT_EQ(lower_median(values), 3);
  EXPECT_EQ(median(values), 3);
}

TEST(Medians, TakeEitherOrTheMeanOfTheTwoInTheMiddle) {
  const std::vector<double> values{8, 1, 4, 2};
  EXPECT_EQ(upper_median(values), 4);
  EXPECT_EQ(lower_median(values), 2);
  EXPECT_EQ(median(values), 3);
}

TEST(Medians, TakeTheOnlyValue) {
  for (const auto& m : {upper_median, lower_median, median}) EXPECT_EQ(m({7}), 7);
}

}  // namespace
}  // namespace radioslam
