#include "radioslam/study/judged_run.hpp"

#include <gtest/gtest.h>

#include "radioslam/study/oracle.hpp"
#include "study/small_town.hpp"

namespace radioslam {
namespace {

TEST(JudgedRun, SharesAreOfTheRightWholes) {
  const PairCounts counts{1000, 200, 160, 150};
  EXPECT_DOUBLE_EQ(*recall(counts), 0.75);
  EXPECT_DOUBLE_EQ(*false_rejected(counts), 790.0 / 800);
  EXPECT_FALSE(recall({10, 0, 2, 0}));
  EXPECT_FALSE(false_rejected({10, 10, 2, 2}));
}

TEST(JudgedRun, TellsErrorPairsAndTimes) {
  const auto [mission, truth] = simulate_city(small_town(), 5);
  const JudgedRun run = run_and_judge(mission, truth, {}, {});
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

TEST(JudgedRun, ComesCloseToTheOracle) {
  const auto [mission, truth] = simulate_city(small_town(), 6);
  const JudgedRun run = run_and_judge(mission, truth, {}, {});
  const auto oracle = oracle_estimate(mission, truth, {});
  ASSERT_TRUE(oracle && run.ate_m);
  EXPECT_LT(*run.ate_m, 1.5 * *ate_rmse_m(*oracle, truth, 2) + 0.5);
}

TEST(JudgedRun, RobotsWithoutATieAreNotCovered) {
  auto [mission, truth] = simulate_city(small_town(), 7);
  mission.ranges.clear();
  mission.arrivals.clear();
  const JudgedRun run = run_and_judge(mission, truth, {}, {});
  EXPECT_LT(run.coverage, 0.6);
}

}  // namespace
}  // namespace radioslam
