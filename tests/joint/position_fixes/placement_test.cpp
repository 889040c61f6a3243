// Position fixes in the joint estimate: they place a team, gross errors are rejected, sigmas are calibrated.
#include "radioslam/joint/position_fixes/placement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pipeline/town_runs.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/graph/marginals.hpp"

namespace radioslam {
namespace {

using test::quick_params;
using test::small_city;

/// A small town with one fix per second and without radio.
Simulation town_of_fixes(std::uint64_t seed, double gross_ratio, int dimension = 2) {
  CityParams params = small_city(600);
  params.dimension = dimension;
  params.gnss.gnss_hz = 1;
  params.gnss.gnss_outlier_ratio = gross_ratio;
  Simulation simulation = simulate_city(params, seed);
  simulation.mission.ranges.clear();
  simulation.mission.aoa_measurements.clear();
  return simulation;
}

/// Without any alignment: the frame is that of the fixes.
double error_in_fixes_frame_m(const RunResult& result, const Truth& truth) {
  double squares = 0, count = 0;
  for (std::size_t r = 0; r < result.robots.size(); ++r)
    for (const auto& [stamp, pose] : result.robots[r].estimate) {
      const auto true_pose = truth.robots[r].poses.at(stamp);
      if (!true_pose) continue;
      squares += (pose.translation() - true_pose->translation()).head<2>().squaredNorm();
      ++count;
    }
  return std::sqrt(squares / count);
}

bool is_gross(const PositionFix& fix, const RobotTruth& truth) {
  return (fix.position_m - truth.poses.at(fix.stamp)->translation()).head<2>().norm() > 6 * fix.sigma_m;
}

TEST(FixStage, ATeamWithoutRadioSharesTheFixesFrame) {
  for (const int dimension : {2, 3}) {
    const auto [mission, truth] = town_of_fixes(5, 0.15, dimension);
    const auto result = run_pipeline(mission, quick_params()).result;
    ASSERT_EQ(result.components.size(), 1U);
    EXPECT_EQ(result.components[0].robots.size(), 2U);
    EXPECT_TRUE(result.unplaced.empty());
    EXPECT_LT(error_in_fixes_frame_m(result, truth), 1.5) << dimension;
    for (const auto& robot : result.robots) {
      ASSERT_TRUE(robot.fixes);
      EXPECT_TRUE(robot.fixes->place);
    }
  }
}

/// The town with its radio, which places the robots relative to each other, and `count` fixes of each.
Simulation town_of_few_fixes(std::uint64_t seed, std::size_t count) {
  CityParams params = small_city(600);
  params.gnss.gnss_hz = 1;
  Simulation simulation = simulate_city(params, seed);
  for (Robot& robot : simulation.mission.robots) {
    const std::vector<PositionFix> all = robot.fixes;
    robot.fixes.clear();
    for (std::size_t k = 0; k < count; ++k)
      robot.fixes.push_back(all[(2 * k + 1) * all.size() / (2 * count)]);
  }
  return simulation;
}

TEST(FixStage, FixesOfAllRobotsPlaceATeamThatNoRobotsOwnPlace) {
  const auto [mission, truth] = town_of_few_fixes(5, 3);
  const auto result = run_pipeline(mission, quick_params()).result;
  ASSERT_EQ(result.components.size(), 1U);
  EXPECT_LT(error_in_fixes_frame_m(result, truth), 2);
  for (const auto& robot : result.robots) {
    ASSERT_TRUE(robot.fixes);
    EXPECT_FALSE(robot.fixes->place);
    EXPECT_GE(robot.fixes->used, 2U);
  }
}

TEST(FixStage, TooFewFixesOfAllLeaveTheTeamInItsOwnFrame) {
  const auto result = run_pipeline(town_of_few_fixes(5, 2).mission, quick_params()).result;
  for (const auto& robot : result.robots) EXPECT_FALSE(robot.fixes->unused.empty());
  EXPECT_LT(result.robots[0].estimate.front().pose.translation().norm(), 1e-6) << "at its start";
}

TEST(FixStage, TakesItsTimeInTheReport) {
  Mission mission = town_of_fixes(5, 0).mission;
  const auto stages = [&] {
    std::vector<std::string> names;
    for (const auto& timing : run_pipeline(mission, quick_params()).result.timings)
      names.push_back(timing.stage);
    return names;
  };
  std::vector<std::string> with = stages();
  EXPECT_EQ(
      std::erase_if(with, [](const auto& s) { return s == "position fixes" || s == "reclassify fixes"; }),
      2U);
  for (Robot& robot : mission.robots) robot.fixes.clear();
  EXPECT_EQ(with, stages());
}

TEST(FixStage, GrossFixesAreOutvoted) {
  const auto [mission, truth] = town_of_fixes(6, 0.35);
  const auto [clean, clean_truth] = town_of_fixes(6, 0);
  const auto result = run_pipeline(mission, quick_params()).result;
  std::size_t gross = 0, rejected = 0, all = 0;
  for (std::size_t r = 0; r < 2; ++r) {
    for (const auto& fix : mission.robots[r].fixes) gross += is_gross(fix, truth.robots[r]);
    rejected += result.robots[r].fixes->rejected;
    all += mission.robots[r].fixes.size();
  }
  ASSERT_GT(gross, all / 5);
  EXPECT_GE(rejected, gross);
  EXPECT_LE(rejected, gross + all / 10);
  const auto by_clean = run_pipeline(clean, quick_params()).result;
  EXPECT_LT(error_in_fixes_frame_m(result, truth), 2 * error_in_fixes_frame_m(by_clean, clean_truth));
}

TEST(FixStage, FewOrCloseFixesDoNotPlaceARobot) {
  auto [mission, truth] = town_of_fixes(7, 0);
  mission.robots[1].fixes.resize(3);
  auto result = run_pipeline(mission, quick_params()).result;
  EXPECT_EQ(result.unplaced, std::vector<std::string>{mission.robots[1].id});
  EXPECT_EQ(result.robots[1].fixes->unused, "too few to place it");
  EXPECT_EQ(result.robots[1].fixes->used, 0U);
  EXPECT_TRUE(result.robots[0].placed);

  for (auto& fix : mission.robots[0].fixes) fix.sigma_m = 500;  // as if all were at one position
  result = run_pipeline(mission, quick_params()).result;
  EXPECT_EQ(result.robots[0].fixes->unused, "too close together, or not precise enough, to give its heading");
}

TEST(FixStage, FixesOfAnotherTimeThanTheOdometryAreNamed) {
  auto [mission, truth] = town_of_fixes(7, 0);
  for (auto& fix : mission.robots[1].fixes) fix.stamp = Stamp::from_seconds(fix.stamp.seconds() + 1000);
  const auto result = run_pipeline(mission, quick_params()).result;
  const std::string about = "robot " + mission.robots[1].id;
  const auto names_them = [&about](const std::string& note) {
    return note.starts_with(about) && note.ends_with("have no odometry at their time");
  };
  EXPECT_EQ(std::count_if(result.notes.begin(), result.notes.end(), names_them), 1);
}

TEST(FixStage, FewFixesConstrainARobotPlacedByRadio) {
  CityParams params = small_city(600);
  params.gnss.gnss_hz = 1;
  params.gnss.gnss_outlier_ratio = 0;
  auto [mission, truth] = simulate_city(params, 2);
  mission.robots[1].fixes.resize(4);
  const auto result = run_pipeline(mission, quick_params()).result;
  EXPECT_EQ(result.components.size(), 1U);
  EXPECT_TRUE(result.robots[1].fixes->unused.empty());
  EXPECT_FALSE(result.robots[1].fixes->place);
  EXPECT_GE(result.robots[1].fixes->used, 3U);
  EXPECT_LT(error_in_fixes_frame_m(result, truth), 1.5);
}

TEST(FixStage, FixesOfAnotherFrameThanTheKnownStartsAreLeftOut) {
  auto [mission, truth] = town_of_fixes(8, 0);
  mission.robots[0].initial_pose = SE3();
  const auto result = run_pipeline(mission, quick_params()).result;
  for (const auto& robot : result.robots) {
    EXPECT_EQ(robot.fixes->used, 0U);
    EXPECT_EQ(robot.fixes->unused, "their frame is not that of the known starts");
  }
}

TEST(FixStage, AnAntennaAwayFromTheBodysOriginIsTakenOff) {
  auto [mission, truth] = town_of_fixes(9, 0);
  const Eigen::Vector3d lever_m(-3, 8, 0.5);
  for (std::size_t r = 0; r < 2; ++r) {
    mission.robots[r].fix_lever_m = lever_m;
    for (auto& fix : mission.robots[r].fixes)
      fix.position_m += truth.robots[r].poses.at(fix.stamp)->rotation() * lever_m;
  }
  const auto result = run_pipeline(mission, quick_params()).result;
  EXPECT_LT(error_in_fixes_frame_m(result, truth), 1.5);
}

/// Mean squared position error over its variance, per axis, at some keyframes of several towns.
TEST(FixStage, SigmasOfPositionsAreCalibrated) {
  double sum = 0, count = 0;
  for (std::uint64_t seed = 20; seed < 32; ++seed) {
    const auto [mission, truth] = town_of_fixes(seed, 0.1);
    const auto output = run_pipeline(mission, quick_params());
    const auto& graph = std::get<PoseGraph2>(output.graph);
    const auto marginals = Marginals<SE2>::compute(graph);
    ASSERT_TRUE(marginals);
    std::size_t first = 0;
    for (std::size_t r = 0; r < 2; ++r) {
      if (!output.result.robots[r].fixes->place) continue;
      const auto& estimate = output.result.robots[r].estimate;
      for (std::size_t k = 5; k < estimate.size(); k += 30) {
        std::size_t id = first;
        while ((graph.poses[id].translation() - estimate[k].pose.translation().head<2>()).norm() > 1e-9) ++id;
        const SE2& pose = graph.poses[id];
        const Eigen::Vector2d error =
            pose.inverse() *
            Eigen::Vector2d(truth.robots[r].poses.at(estimate[k].stamp)->translation().head<2>());
        const Eigen::Matrix2d covariance = marginals->pose(PoseId(id)).topLeftCorner<2, 2>();
        sum += error.dot(covariance.inverse() * error) / 2;
        ++count;
        first = id;
      }
    }
  }
  RecordProperty("nees", std::to_string(sum / count));
  EXPECT_GT(count, 80);
  EXPECT_GT(sum / count, 0.75);
  EXPECT_LT(sum / count, 1.3);
}

TEST(FixStage, ThreadsChangeNothing) {
  const Mission mission = town_of_fixes(10, 0.2).mission;
  const auto poses = [&](std::size_t threads) {
    set_thread_count(threads);
    return run_pipeline(mission, quick_params()).result.robots[1].estimate;
  };
  const auto one = poses(1), four = poses(4);
  set_thread_count(0);
  ASSERT_EQ(one.size(), four.size());
  for (std::size_t k = 0; k < one.size(); ++k)
    EXPECT_EQ(one[k].pose.translation(), four[k].pose.translation());
}

}  // namespace
}  // namespace radioslam
