#include "radioslam/study/wi_closure_hall/wi_closure_hall.hpp"

#include <gtest/gtest.h>

#include "radioslam/study/study_json.hpp"
#include "radioslam/study/study_page.hpp"
#include "radioslam/study/wi_closure_hall/hall_tables.hpp"

namespace radioslam {
namespace {

/// A short drive with coarse scans.
HallParams small_hall() {
  HallParams hall = scanned_hall();
  hall.path_length_m = 8;
  hall.speed_mps = 1;
  hall.onboard.lidar.lidar_beams = 8;
  hall.onboard.lidar.lidar_azimuth_steps = 120;
  hall.onboard.lidar.lidar_rotation_hz = 3;
  return hall;
}

ClosureResult place_closure(const SE3& T_i_j, ClosureStatus status = ClosureStatus::kAccepted) {
  ClosureResult closure;
  closure.robot_i = RobotIndex(0);
  closure.robot_j = RobotIndex(1);
  closure.kind = ClosureKind::kLidar;
  closure.status = status;
  closure.T_i_j = T_i_j;
  return closure;
}

SE3 planar(double x_m, double yaw_rad, double z_m = 0) {
  return lift(SE2(Eigen::Vector2d(x_m, 0), yaw_rad), z_m);
}

/// Two robots that stand 5 m apart for a second.
Truth standing_apart() {
  const auto stand = [](const std::string& id, double x_m) {
    return RobotTruth{id, Trajectory<SE3>({{Stamp::from_seconds(0), planar(x_m, 0)},
                                           {Stamp::from_seconds(1), planar(x_m, 0)}})};
  };
  Truth truth;
  truth.robots = {stand("a", 0), stand("b", 5)};
  return truth;
}

TEST(PlaceTruth, AClosureIsTrueNearTheTrueRelativePose) {
  RunResult result;
  result.closures = {place_closure(planar(5.2, 0.04)), place_closure(planar(5.4, 0)),
                     place_closure(planar(5, 0.06)), place_closure(planar(5, 0), ClosureStatus::kRejected),
                     place_closure(planar(5, 0, 2))};
  result.closures.push_back(place_closure(planar(0, 0)));
  result.closures.back().robot_j = RobotIndex(0);
  result.closures.push_back(place_closure(planar(5, 0)));
  result.closures.back().stamp_j = Stamp::from_seconds(3);
  const PlaceClosures in_plane = count_place_closures(result, standing_apart());
  EXPECT_EQ(in_plane.accepted, 4U);
  EXPECT_EQ(in_plane.true_accepted, 2U);
  result.dimension = 3;
  EXPECT_EQ(count_place_closures(result, standing_apart()).true_accepted, 1U);
}

TEST(AnglePaths, TheLikeliestOfAnAcceptedAngleCounts) {
  AnglePaths angle{3, 1, {0.2, 0.7, 0.1}, true};
  EXPECT_EQ(angle.likeliest(), 1U);
  EXPECT_TRUE(angle.finds_direct());
  angle.direct_path = 0;
  EXPECT_FALSE(angle.finds_direct());
  angle.direct_path = kNoDirectPath;
  EXPECT_FALSE(angle.has_direct());
  EXPECT_FALSE(angle.finds_direct());
  angle = {3, 1, {0.2, 0.25, 0.1}, false};
  EXPECT_FALSE(angle.finds_direct());
  EXPECT_FALSE(AnglePaths{}.likeliest());
}

TEST(AnglePaths, EveryAngleHasTheOutcomeOfItsTime) {
  Mission mission;
  Truth truth;
  RunResult result;
  result.robots.resize(2);
  for (RobotResult& robot : result.robots)
    robot.estimate = Trajectory<SE3>({{Stamp::from_seconds(0), SE3()}, {Stamp::from_seconds(10), SE3()}});
  for (const double t_s : {3.0, 4.0, 12.0}) {
    AoaMeasurement& angle = mission.aoa_measurements.emplace_back();
    angle.stamp = Stamp::from_seconds(t_s);
    angle.receiver = RobotIndex(0);
    angle.transmitter.robot = RobotIndex(1);
    angle.paths.resize(2);
    truth.direct_paths.push_back(1);
    ClosureResult& closure = result.closures.emplace_back();
    closure.kind = ClosureKind::kAoa;
    closure.robot_i = RobotIndex(0);
    closure.robot_j = RobotIndex(1);
    closure.stamp_i = closure.stamp_j = Stamp::from_seconds(t_s < 10 ? 0 : 10);
    closure.path_weights = {1 - t_s / 20, t_s / 20};
  }
  result.closures[1].status = ClosureStatus::kRejected;
  const auto angles = judge_angle_paths(result, mission, truth);
  ASSERT_EQ(angles.size(), 3U);
  EXPECT_EQ(angles[0].weights, result.closures[0].path_weights);
  EXPECT_EQ(angles[1].weights, result.closures[1].path_weights);
  EXPECT_FALSE(angles[1].accepted);
  EXPECT_TRUE(angles[2].finds_direct());
  mission.aoa_measurements.front().transmitter.robot = RobotIndex(0);
  EXPECT_TRUE(judge_angle_paths(result, mission, truth).front().weights.empty());
}

TEST(PlaceSettings, AreThoseOfTheThesis) {
  const PlaceParams original = place_params(PlaceSettings::kDisco, 10),
                    loosened = place_params(PlaceSettings::kLoosenedDisco, 10);
  EXPECT_EQ(original.rounds, 1);
  EXPECT_EQ(original.candidates, 1);
  EXPECT_EQ(original.max_descriptor_distance, 0.2);
  EXPECT_EQ(original.context.rings, 64);
  EXPECT_EQ(original.context.sectors, 60);
  EXPECT_EQ(original.context.max_range_m, 10);
  EXPECT_EQ(original.index.key, "ring");
  EXPECT_EQ(original.index.nearest_keys, 50);
  EXPECT_EQ(loosened.candidates, 10);
  EXPECT_EQ(loosened.max_descriptor_distance, 1);
  EXPECT_EQ(place_params(PlaceSettings::kDefaults, 10).candidates, PlaceParams{}.candidates);
}

class WiClosureHallTable : public testing::Test {
 protected:
  static void SetUpTestSuite() { hall_ = reproduce_wi_closure_hall(small_hall(), 3); }
  static WiClosureHall hall_;
};
WiClosureHall WiClosureHallTable::hall_;

TEST_F(WiClosureHallTable, EveryStageKeepsAPartOfTheOneBefore) {
  const PairCounts& pairs = hall_.search.candidates;
  EXPECT_GT(pairs.true_pairs, 0U);
  EXPECT_GE(pairs.pairs, pairs.kept);
  EXPECT_GE(pairs.kept, pairs.true_kept);
  EXPECT_GE(pairs.true_pairs, pairs.true_kept);
  for (const HallRuns& runs : hall_.runs) {
    for (const HallRun* run : {&runs.without_radio, &runs.unpruned, &runs.pruned}) {
      EXPECT_GT(run->places.pairs, 0U);
      EXPECT_GE(run->places.registrations, run->places.verified);
      EXPECT_GE(run->places.verified, run->closures.accepted);
      EXPECT_GE(run->closures.accepted, run->closures.true_accepted);
      EXPECT_EQ(run->in_one_frame, run->ate_m.has_value());
      EXPECT_GT(run->scans_s, 0);
      EXPECT_GT(run->places_s, 0);
      EXPECT_GE(run->total_s, run->scans_s + run->overlap_s + run->places_s);
    }
    EXPECT_TRUE(runs.unpruned.in_one_frame);
    EXPECT_TRUE(runs.pruned.in_one_frame);
  }
}

TEST_F(WiClosureHallTable, InOneRoundNoPairCountsTwice) {
  for (const std::size_t k : {1U, 2U}) {
    const HallRuns& runs = hall_.runs[k];
    EXPECT_GE(runs.unpruned.places.pairs, runs.unpruned.places.allowed);
    EXPECT_GE(runs.unpruned.places.allowed, runs.pruned.places.allowed);
    EXPECT_GT(runs.pruned.places.allowed, 0U);
    EXPECT_GE(runs.unpruned.places.allowed, runs.unpruned.places.compared);
  }
}

TEST_F(WiClosureHallTable, HoldsThePublishedNumbersAndTheirContradictions) {
  const std::string text = table_text(wi_closure_hall_table({hall_}));
  for (const char* part : {"1,848", "119", "115", "78.7 %", "93.6 %", "17.6", "1.9", "155", "36", "0.5",
                           "defaults: registrations", "DiSCo-SLAM: ATE, m", "loosened: verified",
                           "adds metres to radians", "Seed 3."})
    EXPECT_NE(text.find(part), std::string::npos) << part;
}

TEST_F(WiClosureHallTable, SeveralSeedsGiveTheirMedian) {
  WiClosureHall other = hall_, third = hall_;
  for (WiClosureHall* hall : {&other, &third}) hall->runs[1].pruned.in_one_frame = true;
  other.runs[1].pruned.ate_m = 77.25;
  third.runs[1].pruned.ate_m = 99;
  const std::string text = table_text(wi_closure_hall_table({other, hall_, third}));
  EXPECT_NE(text.find("77.25"), std::string::npos);
  EXPECT_NE(text.find("Medians of 3 seeds"), std::string::npos);
  EXPECT_NE(text.find("3 of 3"), std::string::npos);
  const auto json = wi_closure_hall_json({other, hall_, third});
  EXPECT_EQ(json["seeds"][2]["disco"]["pruned"]["ate_m"], 99);
  EXPECT_EQ(json["published"]["kept"], 119);
}

TEST_F(WiClosureHallTable, AnglesHaveARowEachAndTheirSums) {
  WiClosureHall hall = hall_;
  ASSERT_FALSE(hall.angles.empty());
  for (const AnglePaths& angle : hall.angles) EXPECT_EQ(angle.weights.size(), angle.paths);
  hall.angles = {{5, 2, {0.1, 0.1, 0.8, 0, 0}, true},
                 {4, kNoDirectPath, {0.1, 0.1, 0.1, 0.1}, false},
                 {6, 0, {0.1, 0.9, 0, 0, 0, 0}, true}};
  const AngleCounts counts = count_angles({hall, hall});
  EXPECT_EQ(counts.angles, 6U);
  EXPECT_EQ(counts.with_direct, 4U);
  EXPECT_EQ(counts.direct_found, 2U);
  EXPECT_EQ(counts.paths, 30U);
  const StudyTable table = hall_angles_table({hall, hall});
  EXPECT_EQ(table.rows.size(), 6U);
  EXPECT_EQ(table.rows[0].cells, (std::vector<std::string>{"5", "3", "3", "0.80", "direct"}));
  EXPECT_EQ(table.rows[1].cells, (std::vector<std::string>{"4", "none", "1", "0.10", "rejected rightly"}));
  EXPECT_EQ(table.rows[2].cells, (std::vector<std::string>{"6", "1", "2", "0.90", "another path"}));
  EXPECT_NE(table.lead.find("2 direct of 4 measurements with one, 30 paths"), std::string::npos);
  EXPECT_NE(table.lead.find("3 direct of 17"), std::string::npos);
}

TEST_F(WiClosureHallTable, ThePageHoldsBothTables) {
  const std::string page = render_table_page(wi_closure_hall_table({hall_}), {hall_angles_table({hall_})});
  EXPECT_NE(page.find("\"1,848\""), std::string::npos);
  EXPECT_NE(page.find("\"Paths of the angles\""), std::string::npos);
}

}  // namespace
}  // namespace radioslam
