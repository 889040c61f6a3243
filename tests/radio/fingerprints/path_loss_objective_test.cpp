#include "radioslam/radio/fingerprints/path_loss_objective.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "radioslam/radio/fingerprints/censored_loss.hpp"

namespace radioslam {
namespace {

double exact_cost(double z) { return -2 * std::log(std::erfc(-z / std::numbers::sqrt2) / 2); }

TEST(CensoredLoss, IsMinusTwiceTheLogarithmOfTheNormalDistribution) {
  for (double z = -11.99; z < 7.99; z += 0.0137) {
    const CensoredLoss loss = censored_loss(z);
    EXPECT_NEAR(loss.cost, exact_cost(z), 1e-6) << z;
    const double density = std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi);
    EXPECT_NEAR(loss.hazard, density / (std::erfc(-z / std::numbers::sqrt2) / 2), 1e-6) << z;
  }
}

TEST(CensoredLoss, ContinuesWithTheSameSlopeFarFromTheThreshold) {
  constexpr double kStep = 1e-3;
  for (const double z : {-30.0, -12.0, -11.0, 7.9995, 8.0, 20.0}) {
    const double slope = (censored_loss(z + kStep).cost - censored_loss(z - kStep).cost) / (2 * kStep);
    EXPECT_NEAR(slope, -2 * censored_loss(z).hazard, 1e-4) << z;
  }
  EXPECT_GT(censored_loss(-1e6).cost, 1e12);
  EXPECT_EQ(censored_loss(100).cost, 0);
  EXPECT_TRUE(std::isnan(censored_loss(std::nan("")).cost));
}

/// Readings along two sides of a rectangle, and sites farther away without any.
RssAlongPath around_a_corner() {
  RssAlongPath heard;
  heard.floor_dbm = -80;
  for (double s = 0; s < 40; s += 1.5) {
    const double ripple_db = 4 * std::sin(s);
    heard.readings.push_back({{s, 0}, -50 - s / 3 + ripple_db});
    heard.readings.push_back({{40, s}, -70 + s / 3 - ripple_db});
    heard.undetected_m.emplace_back(-30 - 3 * s, 20 + s);
  }
  return heard;
}

TEST(PathLossObjective, TheGradientIsTheCostsDerivative) {
  const RssAlongPath heard = around_a_corner();
  const PathLossObjective objective(heard_places(heard.readings, {}), heard, {});
  for (const PathLossUnknowns& at : {PathLossUnknowns(12, 7, -42, 2.8), PathLossUnknowns(-20, 30, -30, 3.5),
                                     PathLossUnknowns(60, 1, -55, 2)}) {
    const PathLossCost<4> cost = objective.at(at);
    for (int axis = 0; axis < 4; ++axis) {
      PathLossUnknowns step = PathLossUnknowns::Zero();
      step[axis] = 1e-5;
      const double slope = (objective.at(at + step).cost - objective.at(at - step).cost) / 2e-5;
      EXPECT_NEAR(2 * cost.gradient[axis], slope, 1e-3 * (1 + std::abs(slope))) << axis;
    }
  }
}

TEST(PathLossObjective, APositionHeldGivesTheSameCostGradientAndInformation) {
  const RssAlongPath heard = around_a_corner();
  const PathLossObjective objective(heard_places(heard.readings, {}), heard, {});
  const PathLossUnknowns at(12, 7, -42, 2.8);
  const Eigen::Vector2d position_m = at.head<2>();
  const PathLossCost<4> all = objective.at(at);
  const PathLossCost<2> held = objective.at(at.tail<2>(), objective.heard_decades(position_m).col(0),
                                            objective.undetected_decades(position_m));
  EXPECT_NEAR(held.cost, all.cost, 1e-9 * all.cost);
  EXPECT_NEAR(held.heard_cost, all.heard_cost, 1e-9 * all.cost);
  EXPECT_LT((held.gradient - all.gradient.tail<2>()).norm(), 1e-8 * all.gradient.norm());
  EXPECT_LT((held.information - all.information.bottomRightCorner<2, 2>()).norm(),
            1e-9 * all.information.norm());
}

/// Without censored readings and with a loss that is quadratic, the fitted law is the minimum.
TEST(PathLossObjective, TheFittedLawIsTheLeastSquaresSolution) {
  RssAlongPath heard = around_a_corner();
  heard.undetected_m.clear();
  AccessPointParams params;
  params.loss_sigmas = 1000;
  const PathLossObjective objective(heard_places(heard.readings, params), heard, params);
  const Eigen::VectorXd decades = objective.heard_decades(Eigen::Vector2d(12, 7)).col(0);
  const Eigen::Vector2d law = objective.fitted_law(decades);
  EXPECT_LT(objective.heard_at(law, decades).gradient.norm(), 1e-8);
}

}  // namespace
}  // namespace radioslam
