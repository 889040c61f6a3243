#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "radioslam/team_frame/field_refinement.hpp"

namespace radioslam {
namespace {

constexpr int kPatience = 500;

/// Rosenbrock 1960, pairwise: the minimum is 0 at ones.
ValueAndGradient rosenbrock(const Eigen::VectorXd& x) {
  ValueAndGradient result{0, Eigen::VectorXd::Zero(x.size())};
  for (Eigen::Index i = 0; i + 1 < x.size(); i += 2) {
    const double bend = x[i + 1] - x[i] * x[i], off = 1 - x[i];
    result.value += 100 * bend * bend + off * off;
    result.gradient[i] = -400 * bend * x[i] - 2 * off;
    result.gradient[i + 1] = 200 * bend;
  }
  return result;
}

TEST(Minimise, FollowsRosenbrocksValley) {
  Eigen::VectorXd start(6);
  start << -1.2, 1, 0, 3, 2, -2;
  const Minimum found = minimise_lbfgs(rosenbrock, start, kPatience, 1e-14);
  EXPECT_LT((found.x - Eigen::VectorXd::Ones(6)).norm(), 1e-5);
  EXPECT_LT(found.value, 1e-10);
  EXPECT_LT(found.iterations, kPatience);
}

TEST(Minimise, NeverEndsHigherThanItStarts) {
  Eigen::VectorXd start(2);
  start << -1.2, 1;
  double last = rosenbrock(start).value;
  for (int iterations = 0; iterations < 30; ++iterations) {
    const Minimum found = minimise_lbfgs(rosenbrock, start, iterations, 0);
    EXPECT_LE(found.value, last);
    EXPECT_NEAR(found.value, rosenbrock(found.x).value, 1e-12);
    last = found.value;
  }
}

TEST(Minimise, StepsBackFromWhereTheValueIsInfinite) {
  const auto wall = [](const Eigen::VectorXd& x) {  // x - ln x, with no value left of zero
    ValueAndGradient result{std::numeric_limits<double>::infinity(), Eigen::VectorXd::Zero(1)};
    if (x[0] <= 0) return result;
    result.value = x[0] - std::log(x[0]);
    result.gradient[0] = 1 - 1 / x[0];
    return result;
  };
  EXPECT_NEAR(minimise_lbfgs(wall, Eigen::VectorXd::Constant(1, 30), kPatience, 1e-14).x[0], 1, 1e-5);
}

}  // namespace
}  // namespace radioslam
