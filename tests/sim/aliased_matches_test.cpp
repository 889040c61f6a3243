#include "radioslam/sim/sensors/aliased_matches.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "radioslam/sim/scenarios/city.hpp"

namespace radioslam {
namespace {

struct Town {
  std::vector<Trajectory<SE3>> truth;
};

Town town(int dimension) {
  CityParams params;
  params.dimension = dimension;
  params.path_length_m = 600;
  params.min_contact_s = 4;
  params.robots = 3;
  Town result;
  for (auto& robot : simulate_city(params, 5).truth.robots) result.truth.push_back(std::move(robot.poses));
  return result;
}

constexpr double kWithin_m = 60;

LabelledMatches simulate(const Town& town, const AliasedMatchParams& params, int dimension) {
  return simulate_matches(town.truth, dimension, kWithin_m, upright_alias(kWithin_m), params, Rng(3));
}

SE3 pose_at(const Town& town, RobotIndex robot, Stamp stamp) { return *town.truth[robot.index()].at(stamp); }

TEST(AliasedMatches, TrueOnesAreTheRelativePosesOfNearbyPoses) {
  for (const int dimension : {2, 3}) {
    const Town places = town(dimension);
    AliasedMatchParams params;
    params.matches_true = 400;
    const auto [matches, labels] = simulate(places, params, dimension);
    ASSERT_EQ(matches.size(), 400U);
    double squares = 0;
    for (std::size_t k = 0; k < matches.size(); ++k) {
      const auto& m = matches[k];
      EXPECT_TRUE(*labels[k]);
      EXPECT_NE(m.robot_i, m.robot_j);
      const SE3 T_i_j =
          pose_at(places, m.robot_i, m.stamp_i).inverse() * pose_at(places, m.robot_j, m.stamp_j);
      EXPECT_LT(T_i_j.translation().norm(), kWithin_m);
      const SE3::Tangent error = (T_i_j.inverse() * m.T_i_j).log();
      squares += error.cwiseAbs2().cwiseQuotient(m.covariance.diagonal()).sum();
    }
    const double dof = dimension == 2 ? 3 : 6;
    EXPECT_NEAR(squares / 400, dof, 4 * std::sqrt(2 * dof / 400));
  }
}

/// Without noise, Log(Z_i F Z_j^-1 E^-1) is zero: aliased matches agree with each other, and not with the
/// truth.
TEST(AliasedMatches, FalseOnesAgreeWithEachOther) {
  const Town places = town(2);
  AliasedMatchParams params;
  params.matches_false = 120;
  params.sigma_match_t_m = 0.001;
  params.sigma_match_r_deg = 0.01;
  const auto [matches, labels] = simulate(places, params, 2);
  ASSERT_EQ(matches.size(), 120U);
  const auto moved = [&](const PoseMatch& m) {  // S = T_i Z T_j^-1
    return pose_at(places, m.robot_i, m.stamp_i) * m.T_i_j * pose_at(places, m.robot_j, m.stamp_j).inverse();
  };
  const SE3 first = moved(matches[0]);
  for (std::size_t k = 0; k < matches.size(); ++k) {
    EXPECT_FALSE(*labels[k]);
    EXPECT_LT((first.inverse() * moved(matches[k])).log().norm(), 0.5);
    const SE3 T_j = pose_at(places, matches[k].robot_j, matches[k].stamp_j);
    EXPECT_LT(matches[k].T_i_j.translation().norm(), kWithin_m + 1);
    EXPECT_GT((first * T_j.translation() - T_j.translation()).norm(), 1);
  }
}

TEST(AliasedMatches, AreInTemporalOrderWhateverTheirLabels) {
  AliasedMatchParams params{40, 120, 3};
  const auto [matches, labels] = simulate(town(3), params, 3);
  ASSERT_EQ(matches.size(), 160U);
  int changes = 0;
  for (std::size_t k = 1; k < matches.size(); ++k) {
    EXPECT_LE(matches[k - 1].stamp_i, matches[k].stamp_i);
    changes += labels[k] != labels[k - 1] ? 1 : 0;
  }
  EXPECT_GT(changes, 10);
}

TEST(AliasedMatches, AreNoneUnlessAskedFor) {
  EXPECT_TRUE(simulate(town(2), {}, 2).matches.empty());
  AliasedMatchParams params{5, 5};
  EXPECT_TRUE(simulate({{town(2).truth[0]}}, params, 2).matches.empty());
}

}  // namespace
}  // namespace radioslam
