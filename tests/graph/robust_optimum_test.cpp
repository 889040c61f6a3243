// The robust optimum of a drive whose loop closures are partly wrong.
#include "radioslam/graph/robust_optimum.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace radioslam {
namespace {

constexpr std::size_t kSide = 5, kLaps = 3, kPoses = 4 * kSide * kLaps;
constexpr double kGate = 50;

/// Laps around a square, one step of a metre each, by odometry that turns a little too far; true closures
/// from lap to lap, and wrong ones across the square.
struct Laps {
  PoseGraph2 graph;
  std::vector<SE2> truth;
  std::vector<bool> candidates, is_true;

  Laps() {
    truth.emplace_back();
    for (std::size_t k = 1; k < kPoses; ++k)
      truth.push_back(truth.back() * SE2({1, 0}, k % kSide == 0 ? std::numbers::pi / 2 : 0));
    graph.poses.resize(kPoses);
    for (std::size_t k = 1; k < kPoses; ++k)
      add(k - 1, k, truth[k - 1].inverse() * truth[k] * SE2({0, 0}, 0.004), 0.05, 0.01, true);
    for (std::size_t k = 0; k + 4 * kSide < kPoses; k += 3) add_loop(k, k + 4 * kSide, SE2(), true);
    for (std::size_t k = 0; k < 6; ++k) add_loop(k, 31 + 2 * k, SE2({-4, 3}, 1), false);
  }

  void add(std::size_t i, std::size_t j, const SE2& T_i_j, double sigma_m, double sigma_rad, bool right) {
    RelativePoseFactor<SE2>& factor = graph.relative_poses.emplace_back();
    factor.i = PoseId(i);
    factor.j = PoseId(j);
    factor.T_i_j = T_i_j;
    factor.information =
        Eigen::Vector3d(1 / (sigma_m * sigma_m), 1 / (sigma_m * sigma_m), 1 / (sigma_rad * sigma_rad))
            .asDiagonal();
    candidates.push_back(j != i + 1);
    is_true.push_back(right);
  }

  void add_loop(std::size_t i, std::size_t j, const SE2& off, bool right) {
    add(i, j, truth[i].inverse() * truth[j] * off, 0.05, 0.02, right);
  }

  double error_m() const {
    double largest = 0;
    for (std::size_t k = 0; k < kPoses; ++k)
      largest = std::max(largest, (graph.poses[k].translation() - truth[k].translation()).norm());
    return largest;
  }
};

TEST(RobustOptimum, RejectsWrongClosuresAndNoOthers) {
  Laps laps;
  const RobustOptimum optimum =
      optimize_with_outliers(laps.graph, laps.candidates, kGate, GivenValues::kNone, {});
  ASSERT_EQ(optimum.weights.size(), laps.is_true.size());
  for (std::size_t k = 0; k < laps.is_true.size(); ++k)
    EXPECT_EQ(optimum.weights[k], laps.is_true[k] ? 1 : 0) << k;
  EXPECT_LT(laps.error_m(), 0.3);
  Laps plain;
  initialise(plain.graph, GivenValues::kNone);
  optimize(plain.graph, {});
  EXPECT_GT(plain.error_m(), 1);
}

TEST(RobustOptimum, WithoutCandidatesIsTheOptimum) {
  Laps laps;
  const std::vector<bool> none(laps.candidates.size(), false);
  PoseGraph2 graph = laps.graph;
  const RobustOptimum optimum = optimize_with_outliers(graph, none, kGate, GivenValues::kNone, {});
  initialise(laps.graph, GivenValues::kNone);
  const double cost = optimize(laps.graph, {}).final_cost;
  EXPECT_NEAR(optimum.summary.final_cost, cost, 1e-9 * cost);
}

/// A wrong closure that is stated ten times weighs as one.
TEST(RobustOptimum, RepeatedClosuresWeighAsOne) {
  Laps laps;
  for (int k = 0; k < 10; ++k) laps.add_loop(2, 52, SE2({-4, 3}, 1), false);
  const RobustOptimum optimum =
      optimize_with_outliers(laps.graph, laps.candidates, kGate, GivenValues::kNone, {});
  EXPECT_EQ(optimum.weights.back(), 0);
  EXPECT_LT(laps.error_m(), 0.3);
}

}  // namespace
}  // namespace radioslam
