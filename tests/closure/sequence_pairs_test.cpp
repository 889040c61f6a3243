#include <gtest/gtest.h>

#include "closure/sequence_world.hpp"
#include "radioslam/closure/sequence_match.hpp"

namespace radioslam {
namespace {

/// Points of a curve, each with its true distance to every point of the same curve seen from another pose.
std::vector<PredictedPair> exact_pairs(const SE2& T_j_i) {
  const auto path = bent_way(-6, 0, 0, 7, 1);
  std::vector<PredictedPair> pairs;
  for (const SE2& a : path)
    for (const SE2& b : path) {
      const Eigen::Vector2d q = T_j_i * b.translation();
      pairs.push_back({a.translation(), q, (T_j_i * a.translation() - q).norm(), 1.5});
    }
  return pairs;
}

TEST(SequencePairs, GradientIsThatOfTheCost) {
  const auto pairs = exact_pairs(SE2({3, -2}, 0.4));
  const SE2 at({2.1, -1.2}, 0.7);
  const PairCost here = evaluate_pairs(at, pairs, 2);
  for (int axis = 0; axis < 3; ++axis) {
    const double step = 1e-6;
    const Eigen::Vector3d xi = step * Eigen::Vector3d::Unit(axis);
    const double numerical = (evaluate_pairs(at * SE2::exp(xi), pairs, 2).cost -
                              evaluate_pairs(at * SE2::exp(-xi), pairs, 2).cost) /
                             (2 * step);
    // The gradient is that of half the cost, by the convention of Gauss-Newton.
    EXPECT_NEAR(2 * here.gradient[axis], numerical, 1e-5) << axis;
  }
}

TEST(SequencePairs, ExactDistancesGiveThePoseBack) {
  const SE2 truth({3, -2}, 0.4);
  const PairFit fit = fit_pairs(truth * SE2({1.5, -1}, 0.3), exact_pairs(truth), 2);
  EXPECT_LT((truth.inverse() * fit.T_j_i).log().norm(), 1e-3);
  EXPECT_LT(fit.at.cost, 1e-6);
}

TEST(SequencePairs, AFifthOfWrongDistancesMovesItLittle) {
  const SE2 truth({3, -2}, 0.4);
  auto pairs = exact_pairs(truth);
  for (std::size_t k = 0; k < pairs.size(); k += 5) pairs[k].peak_m += 30;
  const PairFit fit = fit_pairs(truth * SE2({1, -1}, 0.2), pairs, 2);
  EXPECT_LT((truth.inverse() * fit.T_j_i).log().norm(), 0.5);
}

TEST(SequencePairs, OnlyWhatTheModelPredictsTakesPart) {
  const auto radio = lawful_radio({bent_way(0, 0, 0, 3, 0)});
  const auto window = window_around(radio, 1, 10);
  Eigen::MatrixXd similarity = Eigen::MatrixXd::Constant(3, 3, 0.5);
  EXPECT_EQ(predicted_pairs(radio.near_model, similarity, window, window).size(), 9U);
  similarity(0, 2) = -1;
  EXPECT_EQ(predicted_pairs(radio.near_model, similarity, window, window).size(), 8U);
}

}  // namespace
}  // namespace radioslam
