#include "radioslam/study/evaluated_run.hpp"

#include <gtest/gtest.h>

#include "radioslam/study/oracle.hpp"
#include "study/small_town.hpp"

namespace radioslam {
namespace {

TEST(EvaluatedRun, RatiosAreOfTheRightTotals) {
  const PairCounts counts{1000, 200, 160, 150};
  EXPECT_DOUBLE_EQ(*recall(counts), 0.75);
  EXPECT_DOUBLE_EQ(*rejected_false(counts), 790.0 / 800);
  EXPECT_FALSE(recall({10, 0, 2, 0}));
  EXPECT_FALSE(rejected_false({10, 10, 2, 2}));
}

TEST(EvaluatedRun, ReportsErrorPairsAndTimes) {
  const auto [mission, truth] = simulate_city(small_town(), 5);
  const EvaluatedRun run = run_and_evaluate(mission, truth, {}, {});
  ASSERT_TRUE(run.ate_m && run.best_ate_m);
  EXPECT_LE(*run.best_ate_m, *run.ate_m);
  EXPECT_DOUBLE_EQ(run.coverage, 1);
  EXPECT_GT(run.candidates.pairs, 10000U);
  EXPECT_GT(*recall(run.candidates), 0.9);
  EXPECT_GT(run.search_s, 0);
  EXPECT_GT(run.total_s, run.search_s);
  EXPECT_GT(run.distances_evaluated, 0);
  EXPECT_LE(run.weight, 1);
}

TEST(EvaluatedRun, ComesCloseToTheOracle) {
  const auto [mission, truth] = simulate_city(small_town(), 6);
  const EvaluatedRun run = run_and_evaluate(mission, truth, {}, {});
  const auto oracle = oracle_estimate(mission, truth, {});
  ASSERT_TRUE(oracle && run.ate_m);
  EXPECT_LT(*run.ate_m, 1.5 * *ate_rmse_m(*oracle, truth, 2) + 0.5);
}

TEST(EvaluatedRun, UnconnectedRobotsAreNotCovered) {
  auto [mission, truth] = simulate_city(small_town(), 7);
  mission.ranges.clear();
  mission.aoa_measurements.clear();
  const EvaluatedRun run = run_and_evaluate(mission, truth, {}, {});
  EXPECT_LT(run.coverage, 0.6);
}

}  // namespace
}  // namespace radioslam
