// The team alignment on the page: frames, other hypotheses, candidate pairs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <vector>

#include "report/sample_page.hpp"

namespace radioslam {
namespace {

using sample::data_of;
using sample::evaluated_page;
using sample::Json;
using sample::make_sample;
using sample::Sample;

/// Kept pairs per (robot_i, robot_j, bin_i, bin_j).
using Bins = std::map<std::tuple<std::size_t, std::size_t, std::size_t, std::size_t>, std::size_t>;

Bins bins_of(const Json& candidates) {
  Bins bins;
  for (const Json& m : candidates["matrices"])
    for (std::size_t k = 0; k < m["cell"].size(); ++k) {
      const auto cell = m["cell"][k].get<std::size_t>(), width = m["bins_i"].get<std::size_t>();
      bins[{m["robot_i"].get<std::size_t>(), m["robot_j"].get<std::size_t>(), cell % width, cell / width}] =
          m["count"][k].get<std::size_t>();
    }
  return bins;
}

std::size_t keyframe_of(const RunResult& result, RobotIndex robot, Stamp stamp) {
  const auto& estimate = result.robots[robot.index()].estimate;
  std::size_t k = 0;
  while (estimate[k].stamp != stamp) ++k;
  return k;
}

TEST(Report, EveryCandidateIsInItsBin) {
  const Sample sample = make_sample({.keyframes = 100, .closures = 5, .candidates = 900});
  ReportParams params;
  params.max_candidate_cells = 3 * 30 * 30;
  const Json candidates = data_of(evaluated_page(sample, params))["candidates"];
  Bins expected;
  for (const auto& c : sample.result.candidates)
    ++expected[{c.robot_i.index(), c.robot_j.index(),
                keyframe_of(sample.result, c.robot_i, c.stamp_i) * 30 / 100,
                keyframe_of(sample.result, c.robot_j, c.stamp_j) * 30 / 100}];
  EXPECT_EQ(bins_of(candidates), expected);
  EXPECT_EQ(candidates["kept"], 900);
  EXPECT_EQ(candidates["pairs"], 30000);
  EXPECT_EQ(candidates["distances_evaluated"], 1125);
}

TEST(Report, CandidatesInAnyOrderOfTheirRobotsAreTheSame) {
  Sample sample = make_sample({.keyframes = 60, .closures = 5, .candidates = 200});
  const Json before = data_of(evaluated_page(sample))["candidates"];
  CandidateList exchanged;
  for (const CandidateResult& c : sample.result.candidates)
    exchanged.push_back({c.robot_j, c.stamp_j, c.robot_i, c.stamp_i, c.distance_m, c.mahalanobis});
  sample.result.candidates = exchanged;
  EXPECT_EQ(data_of(evaluated_page(sample))["candidates"], before);
}

TEST(Report, TheFullestMatricesAreShownWithinTheBudget) {
  const Sample sample = make_sample({.robots = 12, .keyframes = 200, .closures = 5, .candidates = 20000});
  ReportParams params;
  params.max_matrices = 10;
  params.max_candidate_cells = 2000;
  const Json candidates = data_of(evaluated_page(sample, params))["candidates"];
  std::map<std::pair<int, int>, std::size_t> per_pair;
  for (const auto& c : sample.result.candidates) ++per_pair[{c.robot_i.value, c.robot_j.value}];
  std::vector<std::size_t> sizes;
  for (const auto& [robots, kept] : per_pair) sizes.push_back(kept);
  std::sort(sizes.rbegin(), sizes.rend());
  ASSERT_EQ(candidates["matrices"].size(), 10U);
  EXPECT_EQ(candidates["robot_pairs"], per_pair.size());
  std::size_t cells = 0;
  for (std::size_t m = 0; m < 10; ++m) {
    cells += candidates["matrices"][m]["cell"].size();
    EXPECT_EQ(candidates["matrices"][m]["kept"], sizes[m]);
  }
  EXPECT_LE(cells, 2000U);
  EXPECT_GT(cells, 500U);
}

TEST(Report, WithoutASearchThereAreNoCandidates) {
  const Json candidates =
      data_of(evaluated_page(make_sample({.keyframes = 20, .closures = 5})))["candidates"];
  EXPECT_TRUE(candidates["pairs"].is_null());
  EXPECT_TRUE(candidates["matrices"].empty());
}

TEST(Report, FramesAreRelativeToTheFirstRobot) {
  Sample sample = make_sample({.keyframes = 20, .closures = 5});
  const Eigen::Matrix3d covariance = Eigen::Vector3d(4, 9, 0.0025).asDiagonal();
  const auto add = [&](std::size_t i, std::size_t j) {
    sample.result.transforms.push_back(
        {sample.result.robots[i].id, sample.result.robots[j].id, lift(SE2({3, -4}, 0.5), 0), covariance});
  };
  add(0, 1);
  add(0, 2);
  add(1, 2);
  const Json frames = data_of(evaluated_page(sample))["transforms"];
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[1]["robot_j"], sample.result.robots[2].id);
  EXPECT_EQ(frames[1]["translation_m"].dump(), "[3.0,-4.0,0.0]");
  EXPECT_EQ(frames[1]["yaw_rad"], 0.5);
  EXPECT_NEAR(frames[1]["sigma_position_m"].get<double>(), std::sqrt(6.5), 5e-5);
  EXPECT_EQ(frames[1]["sigma_yaw_rad"], 0.05);
}

TEST(Report, AlternativesAreInThePagesFrameAndEvaluated) {
  const Sample sample = make_sample({.keyframes = 50, .closures = 5, .alternatives = 2});
  const Json data = data_of(evaluated_page(sample));
  ASSERT_EQ(data["alternatives"].size(), 2U);
  EXPECT_EQ(data["weight"], 0.6);
  const auto& other = sample.result.alternatives[1];
  const Json& shown = data["alternatives"][1];
  EXPECT_EQ(shown["weight"], 0.15);
  for (std::size_t r = 0; r < 3; ++r) {
    const Eigen::Vector3d p =
        sample.metrics.T_truth_estimate * other.robots[r].estimate[7].pose.translation();
    EXPECT_NEAR(shown["robots"][r]["x"][7].get<double>(), p.x(), 0.0051);
    EXPECT_NEAR(shown["robots"][r]["y"][7].get<double>(), p.y(), 0.0051);
  }
  std::vector<EstimatedTrajectory> team;
  for (const auto& robot : other.robots) team.push_back({robot.id, robot.estimate});
  EXPECT_NEAR(shown["ate_rmse_m"].get<double>(), evaluate_trajectories(team, sample.truth, 2).ate->rmse_m,
              0.00051);
  EXPECT_GT(shown["ate_rmse_m"].get<double>(), 2);
  const Json without_truth = data_of(render_report(sample.result))["alternatives"];
  EXPECT_FALSE(without_truth[1].contains("ate_rmse_m"));
}

TEST(Report, AlternativesKeepToTheirBudget) {
  const Sample sample = make_sample({.keyframes = 300, .closures = 5, .alternatives = 3});
  ReportParams params;
  params.max_alternative_poses = 180;
  std::size_t poses = 0;
  const Json data = data_of(evaluated_page(sample, params));
  for (const Json& other : data["alternatives"])
    for (const Json& robot : other["robots"]) poses += robot["x"].size();
  EXPECT_LE(poses, 180U);
  EXPECT_GE(poses, 170U);
}

}  // namespace
}  // namespace radioslam
