#include "radioslam/joint/aoa/aoa_integrity.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipeline/town_runs.hpp"

namespace radioslam {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// Static robots in a line, ten metres apart, facing along x, which measure correct angles to each other
/// `times` times.
Mission standing(std::size_t robots, int times) {
  Mission mission;
  for (std::size_t r = 0; r < robots; ++r) {
    Robot& robot = mission.robots.emplace_back();
    robot.id = std::string(1, static_cast<char>('a' + r));
    robot.odometry = Trajectory<SE3>({{Stamp{0}, SE3()}, {Stamp{1000}, SE3()}});
    robot.initial_pose = lift(SE2({10.0 * static_cast<double>(r), 0}, 0));
  }
  for (int k = 0; k < times; ++k)
    for (std::size_t i = 0; i < robots; ++i)
      for (std::size_t j = 0; j < robots; ++j) {
        if (i == j) continue;
        AoaMeasurement measured;
        measured.stamp = Stamp{k};
        measured.receiver = RobotIndex(i);
        measured.transmitter.robot = RobotIndex(j);
        measured.paths = {{j > i ? 0 : std::numbers::pi, std::nullopt, 10 * kDegree, 0}};
        mission.aoa_measurements.push_back(measured);
      }
  return mission;
}

AoaIntegrity claims(const Mission& mission) { return check_self_reports<SE2>(mission, {}, {}, {}); }

using Suspects = std::vector<std::vector<std::string>>;

TEST(CheckClaims, AgreesWithCorrectSelfReports) {
  const AoaIntegrity checks = claims(standing(3, 5));
  ASSERT_EQ(checks.pairs.size(), 6U);
  for (const AoaIntegrityResult& pair : checks.pairs) {
    EXPECT_EQ(pair.measurements, 5U);
    EXPECT_NEAR(pair.median_weight, 1, 1e-6);
    EXPECT_EQ(pair.outlier_ratio, 0);
    EXPECT_EQ(pair.p_value, 1);
    EXPECT_FALSE(pair.contradicted);
  }
  EXPECT_TRUE(checks.suspects.empty());
}

/// Each of b's angles has a density of 0.2 where a path is expected: a likelihood ratio of 5, over 5 angles
/// and both ends 5^10 at most.
TEST(CheckClaims, NamesTheOneWhoseStartIsFalse) {
  Mission mission = standing(3, 5);
  mission.robots[1].initial_pose = lift(SE2({-40, 40}, 90 * kDegree));
  const AoaIntegrity checks = claims(mission);
  EXPECT_EQ(checks.suspects, (Suspects{{"b"}}));
  for (const AoaIntegrityResult& pair : checks.pairs) {
    const bool of_b = pair.receiver == "b" || pair.transmitter == "b";
    EXPECT_EQ(pair.contradicted, of_b) << pair.receiver << pair.transmitter;
    EXPECT_EQ(pair.outlier_ratio, of_b ? 1 : 0);
  }
  EXPECT_NE(angle_notes(checks, CheckedPose::kSelfReported).at(0).find("the pose of b as reported"),
            std::string::npos);
}

TEST(CheckClaims, OfTwoRobotsEitherMayBeWrong) {
  Mission mission = standing(2, 10);
  mission.robots[1].initial_pose = lift(SE2({0, 30}, 0));
  EXPECT_EQ(claims(mission).suspects, (Suspects{{"a", "b"}}));
}

TEST(CheckClaims, AnAnchorIsNotAccused) {
  Mission mission = standing(1, 0);
  mission.anchors.push_back({"P", Eigen::Vector3d(0, 10, 0), 0.1});
  for (int k = 0; k < 12; ++k) {
    AoaMeasurement measured;
    measured.stamp = Stamp{k};
    measured.receiver = RobotIndex(std::size_t{0});
    measured.transmitter.anchor = AnchorIndex(std::size_t{0});
    measured.paths = {{-90 * kDegree, std::nullopt, 10 * kDegree, 0}};
    mission.aoa_measurements.push_back(measured);
  }
  EXPECT_EQ(claims(mission).suspects, (Suspects{{"a"}}));
}

/// A fifth without a direct path is expected and is no evidence.
TEST(CheckClaims, ForgivesMissingPaths) {
  Mission mission = standing(2, 20);
  for (std::size_t k = 0; k < mission.aoa_measurements.size(); k += 5)
    mission.aoa_measurements[k].paths[0].azimuth_rad += 1.5;
  const AoaIntegrity checks = claims(mission);
  EXPECT_TRUE(checks.suspects.empty());
  EXPECT_EQ(checks.pairs[0].p_value, 1);
}

TEST(CheckClaims, WithoutAKnownStartThereIsNoClaim) {
  Mission mission = standing(2, 5);
  mission.robots[1].initial_pose.reset();
  EXPECT_TRUE(claims(mission).pairs.empty());
}

Simulation town(std::uint64_t seed) {
  CityParams params = test::small_city(600);
  params.robots = 3;
  return simulate_city(params, seed);
}

/// From half of the mission on, the reported trajectory is rotated about the position at that time.
void turn_from_half(Robot& robot, double angle_rad) {
  std::vector<StampedPose<SE3>> rows(robot.odometry.begin(), robot.odometry.end());
  const std::size_t half = rows.size() / 2;
  const SE3 there = rows[half].pose;
  for (std::size_t k = half; k < rows.size(); ++k)
    rows[k].pose = there * lift(SE2({0, 0}, angle_rad)) * there.inverse() * rows[k].pose;
  robot.odometry = Trajectory<SE3>(std::move(rows));
}

/// Robots accused by the estimated poses.
std::string accusation(const RunResult& result) {
  for (const std::string& note : result.notes) {
    const std::string start = "the angles of arrival contradict the pose of ";
    if (note.starts_with(start)) return note.substr(start.size(), note.find(" as estimated") - start.size());
  }
  return {};
}

TEST(CheckEstimate, NamesTheRobotWhoseOdometryIsFalseAndNoOther) {
  int named = 0;
  for (const std::uint64_t seed : {11U, 12U, 13U, 14U}) {
    Simulation honest = town(seed);
    const auto result = run_pipeline(honest.mission, test::quick_params()).result;
    EXPECT_EQ(accusation(result), "") << seed;
    EXPECT_EQ(result.angle_checks.size(), 6U);
    turn_from_half(honest.mission.robots[1], std::numbers::pi / 2);
    const std::string accused = accusation(run_pipeline(honest.mission, test::quick_params()).result);
    EXPECT_TRUE(accused.empty() || accused == "b") << seed << ": " << accused;
    named += accused == "b" ? 1 : 0;
  }
  EXPECT_GE(named, 3);
}

/// By self-reported poses alone, which need no estimate: at most one in a thousand is allowed, none is
/// expected.
TEST(CheckClaims, AccusesNobodyInCorrectTowns) {
  for (std::uint64_t seed = 200; seed < 260; ++seed) {
    Simulation honest = town(seed);
    for (std::size_t r = 0; r < 3; ++r)
      honest.mission.robots[r].initial_pose = honest.truth.robots[r].poses.front().pose;
    EXPECT_TRUE(claims(honest.mission).suspects.empty()) << seed;
  }
}

}  // namespace
}  // namespace radioslam
