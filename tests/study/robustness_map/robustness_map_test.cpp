#include "radioslam/study/robustness_map/robustness_map.hpp"

#include <gtest/gtest.h>

#include "radioslam/base/parallel.hpp"
#include "radioslam/study/study_json.hpp"
#include "radioslam/study/study_page.hpp"
#include "study/small_town.hpp"

namespace radioslam {
namespace {

const RobustnessGrid kSmallGrid{{5, 30}, {4}, {2}};

RobustnessSample sample(double ate_m, double best_m, double oracle_m, double weight) {
  return {ate_m, best_m, oracle_m, 0.9, 0.99, weight};
}

TEST(RobustnessSample, FailsBeyondTwiceTheOracleAndAMetre) {
  EXPECT_FALSE(sample(1.0, 1.0, 0.1, 1).failed());  // ten times, but within a metre
  EXPECT_FALSE(sample(9.0, 9.0, 5.0, 1).failed());  // metres, but less than twice
  EXPECT_TRUE(sample(11.0, 11.0, 5.0, 1).failed());
  RobustnessSample nothing = sample(1, 1, 1, 1);
  nothing.ate_m = nothing.best_ate_m = std::nullopt;
  EXPECT_TRUE(nothing.failed());
  EXPECT_FALSE(nothing.ratio());
}

TEST(RobustnessSample, IsConfidentlyWrongOnlyWithoutDoubt) {
  EXPECT_TRUE(sample(50, 50, 5, 0.95).confidently_wrong());
  EXPECT_FALSE(sample(50, 50, 5, 0.6).confidently_wrong());  // its weight admits other hypotheses
  EXPECT_FALSE(sample(50, 6, 5, 0.95).confidently_wrong());  // an alternative was right
  EXPECT_FALSE(sample(6, 6, 5, 1).confidently_wrong());
}

TEST(RobustnessSummary, IsMediansWorstsAndRatios) {
  const RobustnessCell cell{10, 5, 2, {sample(5, 5, 5, 1), sample(20, 20, 5, 1), sample(10, 10, 5, 1)}};
  const auto summary = summarise(cell);
  EXPECT_DOUBLE_EQ(*summary.ratio, 2);
  EXPECT_DOUBLE_EQ(*summary.worst_ratio, 4);
  EXPECT_DOUBLE_EQ(*summary.ate_m, 10);
  EXPECT_DOUBLE_EQ(summary.failed, 1.0 / 3);
  EXPECT_DOUBLE_EQ(summary.confidently_wrong, 1.0 / 3);
  EXPECT_FALSE(summarise({10, 5, 2, {}}).ratio);
}

TEST(RobustnessMap, IsTheSameForAnyNumberOfThreads) {
  const auto map = [](std::size_t threads) {
    set_thread_count(threads);
    return robustness_json(map_robustness(kSmallGrid, small_town(), 1, 1)).dump();
  };
  const std::string alone = map(1), together = map(2);
  set_thread_count(0);
  EXPECT_EQ(alone, together);
}

TEST(RobustnessMap, HasACellPerPointOfTheGrid) {
  double last = 0;
  const auto map = map_robustness({{5}, {3, 6}, {0, 2}}, small_town(), 4, 1,
                                  [&](std::string_view, double fraction) { last = fraction; });
  ASSERT_EQ(map.cells.size(), 4U);
  EXPECT_DOUBLE_EQ(last, 1);
  EXPECT_EQ(map.cells[1].links, 6);
  EXPECT_EQ(map.cells[1].false_paths, 0);
  EXPECT_EQ(map.cells[2].false_paths, 2);
  for (const auto& cell : map.cells) EXPECT_TRUE(cell.samples.front().ate_oracle_m);
  const StudyTable table = robustness_table(map);
  EXPECT_EQ(table.rows.size(), 4U);
  for (const auto& row : table.rows) EXPECT_EQ(row.cells.size(), table.columns.size());
  const std::string page = render_robustness_page(map);
  EXPECT_NE(page.find("\"confidently_wrong\""), std::string::npos);
}

}  // namespace
}  // namespace radioslam
