#include "radioslam/graph/loss.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace radioslam {
namespace {

TEST(Loss, KnownValuesAtScaleTwo) {
  EXPECT_DOUBLE_EQ(evaluate({LossKind::kNone, 2}, 9).cost, 9);
  EXPECT_DOUBLE_EQ(evaluate({LossKind::kHuber, 2}, 4).cost, 4);
  EXPECT_DOUBLE_EQ(evaluate({LossKind::kHuber, 2}, 9).cost, 2 * 2 * 3 - 4);
  EXPECT_DOUBLE_EQ(evaluate({LossKind::kCauchy, 2}, 4).cost, 4 * std::log(2.0));
  EXPECT_DOUBLE_EQ(evaluate({LossKind::kGemanMcClure, 2}, 4).cost, 2);
}

TEST(Loss, WeightIsTheDerivativeAndIsOneAtZero) {
  for (const auto kind : {LossKind::kNone, LossKind::kHuber, LossKind::kCauchy, LossKind::kGemanMcClure}) {
    const Loss loss{kind, 1.7};
    EXPECT_EQ(evaluate(loss, 0).weight, 1);
    EXPECT_EQ(evaluate(loss, 0).cost, 0);
    for (const double s : {0.1, 1.0, 3.0, 50.0}) {
      const double numerical = (evaluate(loss, s + 1e-6).cost - evaluate(loss, s - 1e-6).cost) / 2e-6;
      EXPECT_NEAR(evaluate(loss, s).weight, numerical, 1e-8);
    }
  }
}

}  // namespace
}  // namespace radioslam
