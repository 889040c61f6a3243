// AoA estimation end to end on simulated captures of known waves.
#include "radioslam/radio/aoa/aoa_estimate.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "radio/aoa/simulated_exchange.hpp"

namespace radioslam {
namespace {

using namespace waves;

double error_deg(const AoaPeak& peak, double azimuth_rad) {
  return apart_rad(peak.azimuth_rad, azimuth_rad) / kDegree_rad;
}

SimulatedExchange arc_of(PathsBetween paths) {
  SimulatedExchange exchange;
  exchange.motion = metre_of_arc;
  exchange.paths = std::move(paths);
  return exchange;
}

TEST(AoaEstimate, FindsTheOneWaveOfAMetresArc) {
  for (const double azimuth_rad : {-2.9, -1.4, 0.2, 1.0, 2.3}) {
    const SimulatedExchange exchange = arc_of(wave_from(azimuth_rad));
    const AoaResult result = aoa_of(exchange.two_way(), exchange.trajectory());
    ASSERT_TRUE(result.estimate);
    const AoaEstimate& estimate = *result.estimate;
    ASSERT_FALSE(estimate.peaks.empty());
    EXPECT_LT(error_deg(estimate.peaks.front(), azimuth_rad), 1) << azimuth_rad;
    EXPECT_EQ(estimate.peaks.front().power_db, 0);
    EXPECT_FALSE(estimate.peaks.front().is_cross_term);
    EXPECT_FALSE(estimate.peaks.front().mirror) << "an arc resolves left from right";
    EXPECT_LT(estimate.peaks.front().sigma_rad, 3 * kDegree_rad);
    EXPECT_GT(estimate.explained, 0.8);
    EXPECT_LE(estimate.explained, 1);
    EXPECT_NEAR(estimate.stamp.seconds(), 4, 0.1);
    EXPECT_LT((estimate.T_frame_body.translation() - metre_of_arc(4).translation()).norm(), 0.02);
    EXPECT_GT(estimate.packets, 400U);
  }
}

TEST(AoaEstimate, EveryProfileFindsIt) {
  const SimulatedExchange exchange = arc_of(wave_from(1));
  const ChannelTrack track = exchange.two_way();
  for (const char* profile : {"bartlett", "music", "sparse"}) {
    AoaParams params;
    params.profile = profile;
    const AoaResult result = aoa_of(track, exchange.trajectory(), params);
    ASSERT_TRUE(result.estimate) << profile;
    EXPECT_LT(error_deg(result.estimate->peaks.front(), 1), 2) << profile;
    ASSERT_EQ(result.estimate->profile.size(), 360U);
    EXPECT_GT(result.estimate->explained, 0.5) << profile;
    EXPECT_LE(result.estimate->explained, 1) << profile;
    const auto& power = result.estimate->profile;
    const auto most = std::max_element(power.begin(), power.end()) - power.begin();
    EXPECT_EQ(power[static_cast<std::size_t>(most)], 1);
    EXPECT_LT(apart_rad(-std::numbers::pi + static_cast<double>(most) * kDegree_rad, 1), 2.5 * kDegree_rad);
  }
}

SimulatedExchange straight_path(double azimuth_rad, double length_m) {
  SimulatedExchange exchange = arc_of(wave_from(azimuth_rad));
  exchange.motion = [length_m](double t_s) {
    return SE3({length_m * (t_s - 4) / 4, 0, 0}, Eigen::Quaterniond::Identity());
  };
  return exchange;
}

// A straight path observes the angle to itself: the level directions on either side, not one above.
TEST(AoaEstimate, AStraightPathIsLevelAndHasAMirrorSolutionInEveryProfile) {
  const SimulatedExchange exchange = straight_path(40 * kDegree_rad, 1);
  const ChannelTrack track = exchange.two_way();
  for (const char* profile : {"bartlett", "music", "sparse"}) {
    AoaParams params;
    params.profile = profile;
    const AoaPeak peak = aoa_of(track, exchange.trajectory(), params).estimate->peaks.front();
    EXPECT_LT(apart_rad(std::abs(peak.azimuth_rad), 40 * kDegree_rad), 2 * kDegree_rad) << profile;
    EXPECT_EQ(peak.elevation_rad, 0) << profile;
    ASSERT_TRUE(peak.mirror) << profile;
    EXPECT_LT(apart_rad(peak.mirror->azimuth_rad, -peak.azimuth_rad), 0.5 * kDegree_rad) << profile;
  }
}

TEST(AoaEstimate, TheOnlyPathOfALongTrajectoryIsNoCrossTerm) {
  const SimulatedExchange exchange = straight_path(70 * kDegree_rad, 3);
  const AoaResult result = aoa_of(exchange.two_way(), exchange.trajectory());
  ASSERT_TRUE(result.estimate);
  EXPECT_FALSE(result.estimate->peaks.front().is_cross_term);
  EXPECT_LT(apart_rad(std::abs(result.estimate->peaks.front().azimuth_rad), 70 * kDegree_rad),
            2 * kDegree_rad);
}

TEST(AoaEstimate, AnApertureTooWideIsRefusedBeforeItTakesLong) {
  SimulatedExchange exchange = straight_path(0.7, 10);
  EXPECT_EQ(aoa_of(exchange.two_way(), exchange.trajectory()).reason, AoaFailure::kTooWide);
  exchange = arc_of(wave_from(1));
  ChannelTrack track = exchange.two_way();
  track.lever_arm_m = {1e6, 0, 0};
  EXPECT_EQ(aoa_of(track, exchange.trajectory()).reason, AoaFailure::kTooWide);
}

TEST(AoaEstimate, AChannelOfZerosIsRefused) {
  const SimulatedExchange exchange = arc_of(wave_from(1));
  ChannelTrack track = exchange.two_way();
  track.channel.setZero();
  EXPECT_EQ(aoa_of(track, exchange.trajectory()).reason, AoaFailure::kZeroChannel);
}

/// A metre of arc with varying height.
SimulatedExchange wavy_arc(double azimuth_rad, double elevation_rad, double height_m) {
  SimulatedExchange exchange = arc_of(wave_from(azimuth_rad, elevation_rad));
  exchange.motion = [height_m](double t_s) {
    const SE3 pose = metre_of_arc(t_s);
    const Eigen::Vector3d up(0, 0, height_m * std::sin(2.3 * t_s));
    return SE3(pose.translation() + up, pose.rotation());
  };
  return exchange;
}

TEST(AoaEstimate, HeightsOfCentimetresCount) {
  for (const double elevation_deg : {25.0, -15.0})
    for (const double height_m : {0.01, 0.05, 0.12}) {
      const double azimuth_rad = 40.1 * kDegree_rad, elevation_rad = elevation_deg * kDegree_rad;
      const SimulatedExchange exchange = wavy_arc(azimuth_rad, elevation_rad, height_m);
      const AoaResult result = aoa_of(exchange.two_way(), exchange.trajectory());
      ASSERT_TRUE(result.estimate);
      const AoaPeak& peak = result.estimate->peaks.front();
      EXPECT_LT(error_deg(peak, azimuth_rad), 1) << elevation_deg << ' ' << height_m;
      EXPECT_LT(std::abs(peak.elevation_rad - elevation_rad), 2 * kDegree_rad + peak.elevation_sigma_rad)
          << elevation_deg << ' ' << height_m;
      EXPECT_LT(peak.elevation_sigma_rad, 6 * kDegree_rad);
    }
}

// A level path cannot resolve up from down; without refined elevations the azimuth would be biased.
TEST(AoaEstimate, ALevelPathObservesTheElevationUpToItsSign) {
  for (const double elevation_deg : {10.0, 25.0, -15.0}) {
    const double elevation_rad = elevation_deg * kDegree_rad;
    const SimulatedExchange exchange = arc_of(wave_from(0.7, elevation_rad));
    const AoaResult result = aoa_of(exchange.two_way(), exchange.trajectory());
    ASSERT_TRUE(result.estimate);
    const AoaPeak& peak = result.estimate->peaks.front();
    EXPECT_LT(error_deg(peak, 0.7), 0.8) << elevation_deg;
    const double off_rad = std::abs(peak.elevation_rad - std::abs(elevation_rad));
    EXPECT_GT(peak.elevation_sigma_rad, 4 * kDegree_rad) << elevation_deg;
    EXPECT_LT(off_rad, 1.645 * peak.elevation_sigma_rad) << elevation_deg;
    // Near the level the cosine hardly depends on the elevation.
    if (std::abs(elevation_deg) < 12) continue;
    EXPECT_LT(off_rad, 3 * kDegree_rad) << elevation_deg;
    ASSERT_TRUE(peak.mirror) << elevation_deg;
    EXPECT_EQ(peak.mirror->elevation_rad, -peak.elevation_rad);
    EXPECT_LT(apart_rad(peak.mirror->azimuth_rad, peak.azimuth_rad), 1e-9);
  }
}

TEST(AoaEstimate, AStillRobotIsNoMotion) {
  SimulatedExchange exchange = arc_of(wave_from(1));
  exchange.motion = [](double /*t_s*/) { return metre_of_arc(2); };
  const AoaResult result = aoa_of(exchange.two_way(), exchange.trajectory());
  EXPECT_FALSE(result.estimate);
  EXPECT_EQ(result.reason, AoaFailure::kNoMotion);
}

TEST(AoaEstimate, AShortPathIsNoMotion) {
  SimulatedExchange exchange = arc_of(wave_from(1));
  exchange.motion = [](double t_s) { return on_circle(0.5, 0.05 * t_s); };
  EXPECT_EQ(aoa_of(exchange.two_way(), exchange.trajectory()).reason, AoaFailure::kNoMotion);
}

TEST(AoaEstimate, WithATrajectoryOfAnotherTimeIsNoOdometry) {
  const SimulatedExchange exchange = arc_of(wave_from(1));
  const AoaResult result = aoa_of(exchange.two_way(), exchange.trajectory(100));
  EXPECT_FALSE(result.estimate);
  EXPECT_EQ(result.reason, AoaFailure::kNoOdometry);
}

TEST(AoaEstimate, AFewPacketsAreTooFew) {
  SimulatedExchange exchange = arc_of(wave_from(1));
  exchange.end_s = exchange.begin_s + 0.1;
  exchange.motion = [](double t_s) { return on_circle(0.5, 10 * (t_s - 2)); };
  const AoaResult result = aoa_of(exchange.two_way(), exchange.trajectory());
  EXPECT_FALSE(result.estimate);
  EXPECT_EQ(result.reason, AoaFailure::kTooFewPackets);
  const ChannelTrack track = exchange.two_way();
  const Stamp later = Stamp::from_seconds(50);
  EXPECT_EQ(estimate_aoa(track, exchange.trajectory(), later, later, {}).reason, AoaFailure::kTooFewPackets)
      << "no packets";
}

TEST(AoaEstimate, NeedsTheLeverArmOfABodyThatTurns) {
  SimulatedExchange exchange = arc_of(wave_from(0.7));
  exchange.antennas_m = {{0.16, 0, 0}};
  exchange.motion = [](double t_s) {  // moves slowly while it turns
    return SE3({0.1 * (t_s - 4), 0, 0}, so3_exp({0, 0, 1.2 * (t_s - 4)}));
  };
  ChannelTrack track = exchange.two_way();
  const AoaResult right = aoa_of(track, exchange.trajectory());
  ASSERT_TRUE(right.estimate);
  EXPECT_LT(error_deg(right.estimate->peaks.front(), 0.7), 2);
  track.lever_arm_m.setZero();
  const AoaResult without = aoa_of(track, exchange.trajectory());
  ASSERT_TRUE(without.estimate);
  EXPECT_GT(error_deg(without.estimate->peaks.front(), 0.7), 5);
  EXPECT_LT(without.estimate->explained, 0.7 * right.estimate->explained);
}

TEST(AoaEstimate, RecoversElevationFromAHelix) {
  for (const double elevation_rad : {-0.35, 0.07}) {
    SimulatedExchange exchange = arc_of(wave_from(-1.2, elevation_rad));
    exchange.motion = [](double t_s) {
      SE3 pose = on_circle(0.25, 2 * (t_s - 4));
      return SE3(pose.translation() + Eigen::Vector3d(0, 0, 0.12 * (t_s - 4)), pose.rotation());
    };
    const AoaResult result = aoa_of(exchange.two_way(), exchange.trajectory());
    ASSERT_TRUE(result.estimate);
    EXPECT_LT(error_deg(result.estimate->peaks.front(), -1.2), 2) << elevation_rad;
    EXPECT_NEAR(result.estimate->peaks.front().elevation_rad, elevation_rad, 1.5 * kDegree_rad);
    EXPECT_LT(result.estimate->peaks.front().elevation_sigma_rad, 5 * kDegree_rad);
    EXPECT_FALSE(result.estimate->peaks.front().mirror);
  }
}

}  // namespace
}  // namespace radioslam
