// Simulated position fixes: their noise, and the ratio and duration of episodes of gross errors.
#include "radioslam/sim/sensors/gnss_receiver.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "radioslam/sim/scenarios/city.hpp"

namespace radioslam {
namespace {

TrueMotion long_drive(double end_s) {
  return TrueMotion(Trajectory<SE3>(
      {{Stamp{}, SE3()}, {Stamp::from_seconds(end_s), SE3({end_s, 0, 0}, SE3().rotation())}}));
}

TEST(GnssReceiver, ErrorsHaveTheStatedSigmaOutsideOfSpells) {
  GnssReceiverParams params;
  params.gnss_hz = 2;
  params.gnss_outlier_ratio = 0;
  const auto motion = long_drive(2000);
  const auto fixes = simulate_gnss(motion, params, Rng(1));
  ASSERT_EQ(fixes.size(), 4001U);
  double squares = 0;
  for (const auto& fix : fixes)
    squares += (fix.position_m - motion.pose_at(fix.stamp).translation()).squaredNorm() / 3;
  EXPECT_NEAR(std::sqrt(squares / 4001), params.gnss_sigma_m, 0.03);
  EXPECT_EQ(fixes.front().sigma_m, params.gnss_sigma_m);
}

TEST(GnssReceiver, EpisodesHaveTheirRatioAndDuration) {
  GnssReceiverParams params;
  params.gnss_hz = 1;
  params.gnss_outlier_ratio = 0.2;
  params.gnss_outlier_m = 1000;
  const auto motion = long_drive(20000);
  const auto fixes = simulate_gnss(motion, params, Rng(2));
  double gross = 0, spells = 0;
  bool inside = false;
  for (const auto& fix : fixes) {
    const bool far = (fix.position_m - motion.pose_at(fix.stamp).translation()).norm() > 15;
    gross += far;
    spells += far && !inside;
    inside = far;
  }
  EXPECT_NEAR(gross / static_cast<double>(fixes.size()), 0.2, 0.02);
  EXPECT_NEAR(gross / spells, params.gnss_outlier_s, 0.8);
}

TEST(GnssReceiver, ATownHasNoneUnlessAskedAndIsOtherwiseTheSame) {
  CityParams params;
  params.path_length_m = 300;
  params.min_contact_s = 0;
  const auto without = simulate_city(params, 1).mission;
  params.gnss.gnss_hz = 1;
  const auto with = simulate_city(params, 1).mission;
  ASSERT_EQ(with.robots.size(), without.robots.size());
  EXPECT_TRUE(without.robots[0].fixes.empty());
  EXPECT_GT(with.robots[0].fixes.size(), 20U);
  ASSERT_EQ(with.ranges.size(), without.ranges.size());
  for (std::size_t k = 0; k < with.ranges.size(); ++k)
    EXPECT_EQ(with.ranges[k].range_m, without.ranges[k].range_m);
}

}  // namespace
}  // namespace radioslam
