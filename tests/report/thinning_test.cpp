#include <gtest/gtest.h>

#include "radioslam/report/rounding.hpp"

namespace radioslam {
namespace {

TEST(EvenlySpaced, KeepsAllThatFit) {
  EXPECT_EQ(evenly_spaced(0, 5), (std::vector<std::size_t>{}));
  EXPECT_EQ(evenly_spaced(1, 5), (std::vector<std::size_t>{0}));
  EXPECT_EQ(evenly_spaced(3, 3), (std::vector<std::size_t>{0, 1, 2}));
}

TEST(EvenlySpaced, KeepsBothEndsAndIncreases) {
  for (const std::size_t count : {10u, 97u, 100000u}) {
    const auto kept = evenly_spaced(count, 9);
    ASSERT_EQ(kept.size(), 9u);
    EXPECT_EQ(kept.front(), 0u);
    EXPECT_EQ(kept.back(), count - 1);
    for (std::size_t i = 1; i < kept.size(); ++i) EXPECT_LT(kept[i - 1], kept[i]);
  }
}

TEST(ShareOfBudget, IsInProportionAboveTheBudget) {
  EXPECT_EQ(part_of_budget(30, 100, 100), 30u);
  EXPECT_EQ(part_of_budget(30, 1000, 100), 3u);
  EXPECT_EQ(part_of_budget(1, 1000000, 100), 2u);
}

TEST(NearestKept, IsTheNearest) {
  const std::vector<std::size_t> kept{0, 10, 20};
  EXPECT_EQ(nearest_kept(kept, 0), 0u);
  EXPECT_EQ(nearest_kept(kept, 4), 0u);
  EXPECT_EQ(nearest_kept(kept, 6), 1u);
  EXPECT_EQ(nearest_kept(kept, 19), 2u);
  EXPECT_EQ(nearest_kept(kept, 25), 2u);
}

}  // namespace
}  // namespace radioslam
