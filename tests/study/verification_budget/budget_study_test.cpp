#include "radioslam/study/verification_budget/budget_study.hpp"

#include <gtest/gtest.h>

#include "radioslam/sim/scenarios/hall.hpp"
#include "radioslam/study/study_json.hpp"
#include "radioslam/study/study_page.hpp"
#include "radioslam/study/wi_closure_hall/wi_closure_hall.hpp"

namespace radioslam {
namespace {

using Order = VerificationBudget::Order;

/// A short drive with coarse scans.
BudgetMission small_hall() {
  HallParams hall = scanned_hall();
  hall.path_length_m = 8;
  hall.speed_mps = 1;
  hall.onboard.lidar.lidar_beams = 8;
  hall.onboard.lidar.lidar_azimuth_steps = 120;
  hall.onboard.lidar.lidar_rotation_hz = 3;
  return study_budget("hall", simulate_hall(hall, 1), 1);
}

TEST(BudgetStudy, RunsWithinEveryShareInEveryOrder) {
  const BudgetMission hall = small_hall();
  ASSERT_EQ(hall.runs.size(), 3 * std::size(kBudgetShares));
  EXPECT_GT(hall.all.registrations, 2);
  for (const BudgetRun& run : hall.runs) {
    EXPECT_LE(run.registrations, run.share * hall.all.registrations);
    EXPECT_LE(run.verified, run.registrations);
  }
  EXPECT_EQ(table_text(budget_table({hall})).find("nan"), std::string::npos);
  EXPECT_EQ(verification_budget_json({hall})["missions"][0]["runs"].size(), hall.runs.size());
  EXPECT_NE(render_budget_page({hall}).find("\"budget\""), std::string::npos);
}

TEST(BudgetStudy, TakesMediansOverTheMissionsOfAScenario) {
  const auto mission = [](const std::string& scenario, double ate_m) {
    return BudgetMission{
        scenario, 1, 10, 20, {Order::kWorth, 1, 50, 40, 2.0}, {{Order::kRandom, 0.2, 10, 5, ate_m}}};
  };
  const auto medians =
      budget_medians({mission("hall", 3), mission("streets", 8), mission("hall", 5), mission("hall", 4)});
  ASSERT_EQ(medians.size(), 2U);
  EXPECT_EQ(medians[0].scenario, "hall");
  EXPECT_EQ(medians[0].order, Order::kRandom);
  EXPECT_EQ(medians[0].ate_m, 4);
  EXPECT_EQ(medians[0].ratio, 2);
  EXPECT_EQ(medians[1].ate_m, 8);
}

}  // namespace
}  // namespace radioslam
