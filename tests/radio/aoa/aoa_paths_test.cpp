// AoA estimates with spherical waves, multipath and antenna pairs.
#include <gtest/gtest.h>

#include "radio/aoa/simulated_exchange.hpp"

namespace radioslam {
namespace {

using namespace waves;

SimulatedExchange near_source(double distance_m, double azimuth_rad) {
  SimulatedExchange exchange;
  exchange.motion = [](double t_s) { return on_circle(0.8, 0.5 * (t_s - 2)); };
  exchange.paths = room_paths({}, {});
  const Eigen::Vector3d middle_m = exchange.motion(4) * exchange.antennas_m.front();
  exchange.answerer_m = middle_m + distance_m * towards({azimuth_rad, 0, 0});
  return exchange;
}

double azimuth_from(const Eigen::Vector3d& here_m, const Eigen::Vector3d& there_m) {
  return std::atan2(there_m.y() - here_m.y(), there_m.x() - here_m.x());
}

TEST(AoaPaths, OfANearSourceAreRightWherePlaneWavesAreOff) {
  AoaParams plane;
  plane.min_source_distance_m = 1e6;
  double worst = 0, worst_plane = 0;
  for (const double azimuth_rad : {-2.5, -1.0, 0.4, 1.9, 3.0}) {
    const SimulatedExchange exchange = near_source(2.5, azimuth_rad);
    const ChannelTrack track = exchange.two_way();
    const AoaResult spherical = aoa_of(track, exchange.trajectory());
    const AoaResult planar = aoa_of(track, exchange.trajectory(), plane);
    ASSERT_TRUE(spherical.estimate && planar.estimate);
    const double truth = azimuth_from(spherical.estimate->centre_m, exchange.answerer_m);
    const auto error = [&](const AoaEstimate& e) { return apart_rad(e.peaks.front().azimuth_rad, truth); };
    worst = std::max(worst, error(*spherical.estimate));
    worst_plane = std::max(worst_plane, error(*planar.estimate));
    EXPECT_GT(spherical.estimate->explained, planar.estimate->explained + 0.05) << azimuth_rad;
    EXPECT_NEAR(1 / spherical.estimate->peaks.front().curvature_per_m, 2.5, 0.5) << azimuth_rad;
  }
  EXPECT_LT(worst, 1 * kDegree_rad);
  EXPECT_GT(worst_plane, 2 * worst);
  EXPECT_GT(worst_plane, 1.5 * kDegree_rad);
}

TEST(AoaPaths, OfAnAntennaPairNeedARotationOnly) {
  for (const double azimuth_rad : {-2.0, 0.5, 2.8}) {
    SimulatedExchange exchange;
    exchange.antennas_m = {{0.1, 0.0135, 0}, {0.1, -0.0135, 0}};
    exchange.motion = [](double t_s) { return SE3({1, 2, 0}, so3_exp({0, 0, 1.2 * (t_s - 3)})); };
    exchange.paths = wave_from(azimuth_rad);
    const AoaResult result = aoa_of(exchange.antenna_pair(), exchange.trajectory());
    ASSERT_TRUE(result.estimate);
    EXPECT_LT(apart_rad(result.estimate->peaks.front().azimuth_rad, azimuth_rad), 3 * kDegree_rad);
    EXPECT_EQ(result.estimate->peaks.front().curvature_per_m, 0) << "distance is unobservable";
  }
}

TEST(AoaPaths, CrossTermsAreMarkedAndPathsAreNot) {
  const double left = 20 * kDegree_rad, right = 80 * kDegree_rad, between = 50 * kDegree_rad;
  SimulatedExchange exchange;
  exchange.motion = metre_of_arc;
  exchange.paths = plane_wave_paths({{left, 0, -15, 3e-8}, {right, 0, -20, 5e-8}});
  int marked = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    exchange.seed = seed;
    const AoaResult result = aoa_of(exchange.two_way(), exchange.trajectory());
    ASSERT_TRUE(result.estimate);
    EXPECT_LT(apart_rad(result.estimate->peaks.front().azimuth_rad, left), 2 * kDegree_rad) << seed;
    for (const AoaPeak& peak : result.estimate->peaks) {
      if (std::min(apart_rad(peak.azimuth_rad, left), apart_rad(peak.azimuth_rad, right)) < 3 * kDegree_rad) {
        EXPECT_FALSE(peak.is_cross_term) << seed;
      }
      if (apart_rad(peak.azimuth_rad, between) < 5 * kDegree_rad) {
        ++marked;
        EXPECT_TRUE(peak.is_cross_term) << seed;
        EXPECT_NEAR(std::cos(peak.elevation_rad), std::cos((right - left) / 2), 0.03)
            << "half the sum of two unit vectors is short, like the projection of an elevated direction";
      }
    }
  }
  EXPECT_GE(marked, 3) << "or the test shows nothing";
}

// Wrong signs in the square root split a wave into two neighbours, whose product is at the original
// direction.
TEST(AoaPaths, ASplitWaveIsNoCrossTerm) {
  const double left = 20 * kDegree_rad, right = 80 * kDegree_rad;
  SimulatedExchange exchange;
  exchange.motion = metre_of_arc;
  exchange.paths = plane_wave_paths({{left, 0, -15, 3e-8}, {right, 0, -18, 5e-8}});
  int marked = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    exchange.seed = seed;
    const AoaResult result = aoa_of(exchange.two_way(), exchange.trajectory());
    ASSERT_TRUE(result.estimate);
    for (const AoaPeak& peak : result.estimate->peaks)
      if (apart_rad(peak.azimuth_rad, left) < 2 * kDegree_rad && peak.is_cross_term) ++marked;
  }
  EXPECT_LE(marked, 1);
}

TEST(AoaPaths, OfOneWaveHaveNoCrossTerm) {
  SimulatedExchange exchange;
  exchange.motion = metre_of_arc;
  exchange.paths = wave_from(0.3);
  const AoaResult result = aoa_of(exchange.two_way(), exchange.trajectory());
  ASSERT_TRUE(result.estimate);
  for (const AoaPeak& peak : result.estimate->peaks) EXPECT_FALSE(peak.is_cross_term);
}

}  // namespace
}  // namespace radioslam
