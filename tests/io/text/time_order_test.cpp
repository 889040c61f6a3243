#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "radioslam/base/random.hpp"
#include "radioslam/io/text/skipped_records.hpp"

namespace radioslam {
namespace {

using RowNumbers = std::vector<std::size_t>;

TEST(TimeOrder, KeepsAllOfAnOrderedLog) {
  EXPECT_EQ(rows_in_time_order(std::vector<Stamp>{{1}, {2}, {5}}), (RowNumbers{0, 1, 2}));
  EXPECT_EQ(rows_in_time_order(std::vector<Stamp>{}), RowNumbers{});
}

TEST(TimeOrder, LeavesOutTheRowsThatAreStampedEarlyLateOrTwice) {
  EXPECT_EQ(rows_in_time_order(std::vector<Stamp>{{90}, {1}, {2}, {3}}), (RowNumbers{1, 2, 3})) << "late";
  EXPECT_EQ(rows_in_time_order(std::vector<Stamp>{{1}, {2}, {0}, {3}}), (RowNumbers{0, 1, 3})) << "early";
  EXPECT_EQ(rows_in_time_order(std::vector<Stamp>{{1}, {2}, {2}, {3}}).size(), 3U) << "twice";
}

TEST(TimeOrder, SortsRowsThatAreOutOfOrderByLessThanASecond) {
  const auto at = [](std::vector<double> seconds) {
    std::vector<Stamp> stamps;
    for (const double s : seconds) stamps.push_back(Stamp::from_seconds(s));
    return sort_rows_by_time(stamps);
  };
  EXPECT_EQ(at({0, 0.1, 0.05, 0.2}).kept, (RowNumbers{0, 2, 1, 3}));
  EXPECT_EQ(at({0, 0.1, 0.05, 0.2}).moved, 1U);
  EXPECT_EQ(at({1, 1, 2}).kept, (RowNumbers{0, 1, 2})) << "equal times stay in their order";
  EXPECT_EQ(at({5, 6, 90, 7, 0, 8}).outside, (RowNumbers{2, 4}));
  EXPECT_EQ(at({5, 6, 90, 7, 0, 8}).kept, (RowNumbers{0, 1, 3, 5}));
  EXPECT_TRUE(at({}).kept.empty());
}

// By trying every subset.
TEST(TimeOrder, KeepsAsManyRowsAsPossible) {
  Rng rng(5);
  for (int repetition = 0; repetition < 200; ++repetition) {
    std::vector<Stamp> stamps(1 + rng.below(10));
    for (Stamp& stamp : stamps) stamp.ns = static_cast<std::int64_t>(rng.below(8));
    std::size_t most = 0;
    for (unsigned subset = 0; subset < 1U << stamps.size(); ++subset) {
      std::vector<Stamp> chosen;
      for (std::size_t row = 0; row < stamps.size(); ++row)
        if (subset >> row & 1U) chosen.push_back(stamps[row]);
      if (std::adjacent_find(chosen.begin(), chosen.end(), std::greater_equal<>()) == chosen.end())
        most = std::max(most, chosen.size());
    }
    const auto rows = rows_in_time_order(stamps);
    EXPECT_EQ(rows.size(), most);
    for (std::size_t k = 1; k < rows.size(); ++k) {
      EXPECT_LT(rows[k - 1], rows[k]);
      EXPECT_LT(stamps[rows[k - 1]], stamps[rows[k]]);
    }
  }
}

}  // namespace
}  // namespace radioslam
