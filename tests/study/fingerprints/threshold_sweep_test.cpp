#include "radioslam/study/fingerprints/threshold_sweep.hpp"

#include <gtest/gtest.h>

#include "pipeline/small_carpark.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/study/evaluated_run.hpp"
#include "radioslam/study/study_json.hpp"

namespace radioslam {
namespace {

TEST(ThresholdSweep, FindsTheBestCell) {
  const SweptMission mission{"9", 10.0, 0.6, {{5, 1, 0.8}, {7, {}, 0.5}, {10, {}, {}}}};
  ASSERT_NE(mission.best(), nullptr);
  EXPECT_EQ(label_of(*mission.best()), "ν 7 m, least squares");
  EXPECT_DOUBLE_EQ(*mission.default_over_best(), 1.2);
  EXPECT_DOUBLE_EQ(*mission.default_over_dead_reckoning(), 0.06);
  const SweptMission nothing{"9", 10.0, 0.6, {{5, 1, {}}}};
  EXPECT_EQ(nothing.best(), nullptr);
  EXPECT_FALSE(nothing.default_over_best());
}

TEST(ThresholdSweep, SumsUpTheMissions) {
  const std::vector<SweptMission> missions{
      {"1", 10.0, 0.5, {{5, 1, 0.5}}}, {"2", 20.0, 1.2, {{5, 0.5, 1.0}}}, {"3", 10.0, 0.8, {{5, 2, 1.0}}}};
  const StudyTable table = threshold_sweep_table(missions);
  ASSERT_EQ(table.rows.size(), 5U);
  EXPECT_EQ(table.rows[1].label, "mission 2");
  EXPECT_EQ(table.rows[1].cells,
            (std::vector<std::string>{"20.00", "1.20", "1.00", "ν 5 m, Cauchy 0.5 σ", "1.200", "0.060"}));
  EXPECT_EQ(table.rows[3].cells, (std::vector<std::string>{"", "", "", "", "1.000", "0.060"}));
  EXPECT_EQ(table.rows[4].cells, (std::vector<std::string>{"", "", "", "", "1.200", "0.080"}));
}

TEST(ThresholdSweep, RepeatsTheDefaultWhereTheCellIsIt) {
  const FingerprintClosureParams closure;
  const ThresholdGrid grid{{closure.within_distance_m}, {RobustParams{}.final_scale}};
  const auto missions = sweep_thresholds(simulated_carparks(short_drives(), 3, 1), grid);
  ASSERT_EQ(missions.size(), 1U);
  ASSERT_EQ(missions[0].cells.size(), 1U);
  EXPECT_EQ(missions[0].cells[0].ate_m, missions[0].default_ate_m)
      << "the model predicts less than a third of the limit here";
  const auto [mission, truth] = simulate_carpark(short_drives(), 3);
  EXPECT_EQ(missions[0].default_ate_m, run_and_evaluate(mission, truth, {}, {}).ate_m)
      << "access points come after the estimate";
}

TEST(ThresholdSweep, TakesAnyMeasureOnAnyMission) {
  CarparkParams carpark = short_drives();
  carpark.drive.path_length_m = 60;
  auto missions = simulated_carparks(carpark, 4, 1);
  missions[0].seed.reset();
  missions[0].mission.name = "hall";
  const auto swept = sweep_thresholds(missions, {{5}, {1}}, {"gaussian", "sorensen"});
  ASSERT_EQ(swept.size(), 2U);
  EXPECT_EQ(threshold_sweep_table(swept).rows[0].label, "mission hall, gaussian");
  EXPECT_NE(swept[0].default_ate_m, swept[1].default_ate_m);
  RunParams params;
  params.radio.measure = "gaussian";
  EXPECT_EQ(swept[0].default_ate_m,
            run_and_evaluate(missions[0].mission, missions[0].truth, params, {}).ate_m);
  const auto json = threshold_sweep_json(swept)["missions"][1];
  EXPECT_EQ(json["mission"], "hall");
  EXPECT_EQ(json["measure"], "sorensen");
}

TEST(ThresholdSweep, IsTheSameForAnyNumberOfThreads) {
  CarparkParams carpark = short_drives();
  carpark.drive.path_length_m = 60;
  const ThresholdGrid grid{{5, 20}, {{}, 1}};
  set_thread_count(1);
  const auto alone = threshold_sweep_json(sweep_thresholds(simulated_carparks(carpark, 4, 1), grid)).dump();
  set_thread_count(3);
  const auto together =
      threshold_sweep_json(sweep_thresholds(simulated_carparks(carpark, 4, 1), grid)).dump();
  set_thread_count(0);
  EXPECT_EQ(alone, together);
}

}  // namespace
}  // namespace radioslam
