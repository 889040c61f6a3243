#include "radioslam/geometry/levenberg_marquardt.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <limits>

namespace radioslam {
namespace {

struct Objective {
  double cost = 0;
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  Eigen::Matrix2d information = Eigen::Matrix2d::Identity();
};

/// Rosenbrock's function as a sum of two squared residuals, 1 - x and 10 (y - x^2).
Objective rosenbrock(const Eigen::Vector2d& at) {
  const Eigen::Vector2d residual(1 - at.x(), 10 * (at.y() - at.x() * at.x()));
  Eigen::Matrix2d jacobian;
  jacobian << -1, 0, -20 * at.x(), 10;
  return {residual.squaredNorm(), jacobian.transpose() * residual, jacobian.transpose() * jacobian};
}

Eigen::Vector2d add(const Eigen::Vector2d& at, const Eigen::Vector2d& move) { return at + move; }

TEST(LevenbergMarquardt, FindsTheMinimumOfACurvedValley) {
  const Eigen::Vector2d start(-1.2, 1);
  const auto best = levenberg_marquardt(start, {.max_steps = 100, .settled = 1e-10}, rosenbrock, add);
  EXPECT_NEAR(best.at.x(), 1, 1e-8);
  EXPECT_NEAR(best.at.y(), 1, 1e-8);
  EXPECT_LT(best.objective.cost, 1e-16);
}

TEST(LevenbergMarquardt, NeverReturnsMoreThanTheStartsCost) {
  const Eigen::Vector2d start(-1.2, 1);
  double before = rosenbrock(start).cost;
  for (int steps = 0; steps < 30; ++steps) {
    const double cost = levenberg_marquardt(start, {.max_steps = steps}, rosenbrock, add).objective.cost;
    EXPECT_LE(cost, before);
    before = cost;
  }
}

TEST(LevenbergMarquardt, StaysWhereAMoveIsNotFinite) {
  const Eigen::Vector2d start(3, 4);
  const auto broken = [](const Eigen::Vector2d&) {
    Objective objective;
    objective.gradient.setConstant(std::numeric_limits<double>::quiet_NaN());
    return objective;
  };
  EXPECT_EQ(levenberg_marquardt(start, {}, broken, add).at, start);
}

}  // namespace
}  // namespace radioslam
