#include "radioslam/study/fingerprints/fingerprint_tables.hpp"

#include <gtest/gtest.h>

#include "pipeline/small_carpark.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/study/evaluated_run.hpp"
#include "radioslam/study/study_json.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kGaussian = 1, kDetection1 = 2, kDetection4 = 3;

TEST(FingerprintTables, HoldWhatThePaperPrints) {
  EXPECT_EQ(published_ate_m(0, {kDetection4, 35, 0}), 3.261);
  EXPECT_EQ(published_ate_m(1, {kGaussian, 20, 0}), 3.951);
  EXPECT_EQ(published_ate_m(0, {kDetection4, 30, 10}), 2.358) << "the best of table II";
  EXPECT_EQ(published_ate_m(1, {kDetection4, 20, 10}), 2.736) << "the best of table III";
  EXPECT_EQ(published_ate_m(1, {kGaussian, 40, 40}), 26.288);
  EXPECT_EQ(published_ate_m(0, {kDetection1, 20, 10}), std::nullopt) << "with one robot only";
  EXPECT_EQ(published_ate_m(0, {kDetection4, 15, 10}), std::nullopt);
  EXPECT_EQ(published_ate_m(0, {kDetection4, 7, 0}), std::nullopt);
}

TEST(FingerprintTables, WithoutPairsIsDeadReckoning) {
  const auto [mission, truth] = simulate_carpark(short_drives(), 3);
  const auto alone = published_algorithm_ate_m(mission, truth, {kGaussian, 0, 0});
  const auto reckoned = dead_reckoning_ate_m(mission, truth);
  ASSERT_TRUE(alone && reckoned);
  EXPECT_NEAR(*alone, *reckoned, 0.01 * *reckoned) << "keyframes against every odometry sample";
}

TEST(FingerprintTables, PairsBetweenRobotsTakeTheErrorDown) {
  const auto [mission, truth] = simulate_carpark(short_drives(), 3);
  const auto reckoned = dead_reckoning_ate_m(mission, truth);
  const auto team = published_algorithm_ate_m(mission, truth, {kGaussian, 10, 10});
  ASSERT_TRUE(team && reckoned);
  EXPECT_LT(*team, 0.6 * *reckoned);
}

TEST(FingerprintTables, TakeDevicesAsTheyAre) {
  auto [mission, truth] = simulate_carpark(short_drives(), 3);
  const auto alone = published_algorithm_ate_m(mission, truth, {kGaussian, 10, 0});
  for (WifiScan& scan : mission.robots[1].wifi)
    for (WifiReading& reading : scan.readings) reading.rssi_dbm -= 25;
  const auto team = published_algorithm_ate_m(mission, truth, {kGaussian, 10, 10});
  ASSERT_TRUE(team && alone);
  EXPECT_NEAR(*team, *alone, 0.05 * *alone) << "the Gaussian measure finds nothing alike 25 dB apart";
}

TEST(FingerprintTables, MeansLeaveOutWhatIsMissing) {
  EXPECT_EQ(mean_of({1.0, std::nullopt, 4.0}), 2.5);
  EXPECT_EQ(mean_of({std::nullopt}), std::nullopt);
}

TEST(FingerprintTables, PutThePublishedFiguresBesideTheMeans) {
  const FingerprintTables tables{{{{}, {}, 7}}, {{kGaussian, 20, 5, {2.0, 3.0}}}, {0.5, 0.7}, {10.0, 20.0}};
  const StudyTable table = fingerprint_tables_table(tables);
  ASSERT_EQ(table.rows.size(), 3U);
  EXPECT_EQ(table.rows[0].cells, (std::vector<std::string>{"–", "–", "0.60", "0.040"}));
  EXPECT_EQ(table.rows[1].cells, (std::vector<std::string>{"19.25", "10.12", "15.00", "1.000"}));
  EXPECT_EQ(table.rows[2].label, "II, III: ν_s 20, Gaussian, ν_p 5");
  EXPECT_EQ(table.rows[2].cells, (std::vector<std::string>{"3.51", "3.25", "2.50", "0.167"}));
}

TEST(FingerprintTables, TakeAnyMeasureOnAnyMission) {
  EXPECT_EQ(fingerprint_measures("").size(), kPublishedMeasures);
  EXPECT_EQ(fingerprint_measures("all").size(), kFingerprintMeasures.size());
  EXPECT_EQ(fingerprint_measures("detection"), (std::vector<std::size_t>{2, 3, 4}));
  EXPECT_TRUE(fingerprint_measures("manhattan").empty());
  CarparkParams carpark = short_drives();
  carpark.drive.path_length_m = 60;
  auto missions = simulated_carparks(carpark, 4, 1);
  missions[0].seed.reset();
  missions[0].mission.name = "hall";
  const auto tables = measure_fingerprint_tables(missions, fingerprint_measures("sorensen"));
  ASSERT_EQ(tables.cells.size(), 9U + 6U * 8);
  for (const FingerprintCell& cell : tables.cells) {
    EXPECT_EQ(published_ate_m(0, cell), std::nullopt);
    EXPECT_TRUE(cell.ate_m.size() == 1 && cell.ate_m[0]);
  }
  EXPECT_EQ(fingerprint_tables_table(tables).lead.find("Mission hall: the published algorithm over"), 0U)
      << fingerprint_tables_table(tables).lead;
  EXPECT_EQ(fingerprint_tables_json(tables)["missions"][0], "hall");
}

TEST(FingerprintTables, TakeStartsThatAreNotStatedFromTheTruth) {
  CarparkParams carpark = short_drives();
  auto missions = simulated_carparks(carpark, 4, 1);
  const auto stated = missions[0].mission.robots[1].initial_pose;
  ASSERT_TRUE(stated.has_value());
  missions[0].mission.robots[1].initial_pose.reset();
  std::vector<StampedPose<SE3>> turned;  // a compass's frame
  for (auto row : missions[0].mission.robots[1].odometry) {
    row.pose = lift(SE2({5, 3}, 1)) * row.pose;
    turned.push_back(row);
  }
  missions[0].mission.robots[1].odometry = Trajectory<SE3>(std::move(turned));
  take_starts_of_truth(missions[0]);
  EXPECT_EQ(missions[0].starts_of_truth, 1U);
  const auto taken = missions[0].mission.robots[1].initial_pose;
  ASSERT_TRUE(taken.has_value());
  EXPECT_LT((taken->translation() - stated->translation()).norm(), 10) << "the odometry's drift over 150 m";
  const auto reckoned = dead_reckoning_ate_m(missions[0].mission, missions[0].truth);
  const auto alone = published_algorithm_ate_m(missions[0].mission, missions[0].truth, {kGaussian, 0, 0});
  ASSERT_TRUE(reckoned && alone);
  EXPECT_NEAR(*alone, *reckoned, 0.02 * *reckoned);
  missions[0].mission.robots[1].initial_pose.reset();
  missions[0].truth.robots[1].poses = {};
  take_starts_of_truth(missions[0]);
  EXPECT_EQ(of_unknown_start(missions[0].mission), missions[0].mission.robots[1].id);
}

TEST(FingerprintTables, AreTheSameForAnyNumberOfThreads) {
  CarparkParams carpark = short_drives();
  carpark.drive.path_length_m = 60;
  set_thread_count(1);
  const auto alone = measure_fingerprint_tables(simulated_carparks(carpark, 4, 1), fingerprint_measures(""));
  set_thread_count(3);
  const auto together =
      measure_fingerprint_tables(simulated_carparks(carpark, 4, 1), fingerprint_measures(""));
  set_thread_count(0);
  EXPECT_EQ(fingerprint_tables_json(alone).dump(), fingerprint_tables_json(together).dump());
  ASSERT_EQ(alone.cells.size(), 5U * 9 + 6U * 3 * 8);
  for (const FingerprintCell& cell : alone.cells) {
    EXPECT_TRUE(cell.ate_m.size() == 1 && cell.ate_m[0]);
    EXPECT_TRUE(published_ate_m(0, cell) && published_ate_m(1, cell)) << "no cell without its figure";
  }
}

}  // namespace
}  // namespace radioslam
