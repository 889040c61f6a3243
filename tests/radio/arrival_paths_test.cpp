// Waves that are bent, waves that are several, and antennas against each other.
#include <gtest/gtest.h>

#include "radio/simulated_exchange.hpp"

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

TEST(ArrivalPaths, OfANearSourceAreRightWherePlaneWavesAreOff) {
  ArrivalParams plane;
  plane.nearest_source_m = 1e6;
  double worst = 0, worst_plane = 0;
  for (const double azimuth_rad : {-2.5, -1.0, 0.4, 1.9, 3.0}) {
    const SimulatedExchange exchange = near_source(2.5, azimuth_rad);
    const ChannelTrack track = exchange.two_way();
    const ArrivalResult bent = arrival_of(track, exchange.trajectory());
    const ArrivalResult flat = arrival_of(track, exchange.trajectory(), plane);
    ASSERT_TRUE(bent.estimate && flat.estimate);
    const double truth = azimuth_from(bent.estimate->centre_m, exchange.answerer_m);
    const auto error = [&](const ArrivalEstimate& e) {
      return apart_rad(e.peaks.front().azimuth_rad, truth);
    };
    worst = std::max(worst, error(*bent.estimate));
    worst_plane = std::max(worst_plane, error(*flat.estimate));
    EXPECT_GT(bent.estimate->explained, flat.estimate->explained + 0.05) << azimuth_rad;
    EXPECT_NEAR(1 / bent.estimate->peaks.front().curvature_per_m, 2.5, 0.5) << azimuth_rad;
  }
  EXPECT_LT(worst, 1 * kDegree_rad);
  EXPECT_GT(worst_plane, 2 * worst);
  EXPECT_GT(worst_plane, 1.5 * kDegree_rad);
}

TEST(ArrivalPaths, OfAntennasAgainstEachOtherNeedATurnOnly) {
  for (const double azimuth_rad : {-2.0, 0.5, 2.8}) {
    SimulatedExchange exchange;
    exchange.antennas_m = {{0.1, 0.0135, 0}, {0.1, -0.0135, 0}};
    exchange.motion = [](double t_s) { return SE3({1, 2, 0}, so3_exp({0, 0, 1.2 * (t_s - 3)})); };
    exchange.paths = wave_from(azimuth_rad);
    const ArrivalResult result = arrival_of(exchange.antenna_pair(), exchange.trajectory());
    ASSERT_TRUE(result.estimate);
    EXPECT_LT(apart_rad(result.estimate->peaks.front().azimuth_rad, azimuth_rad), 3 * kDegree_rad);
    EXPECT_EQ(result.estimate->peaks.front().curvature_per_m, 0) << "it knows no distance";
  }
}

TEST(ArrivalPaths, ProductsOfTwoPathsAreNamedAndPathsAreNot) {
  const double left = 20 * kDegree_rad, right = 80 * kDegree_rad, between = 50 * kDegree_rad;
  SimulatedExchange exchange;
  exchange.motion = metre_of_arc;
  exchange.paths = plane_wave_paths({{left, 0, -15, 3e-8}, {right, 0, -20, 5e-8}});
  int named = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    exchange.seed = seed;
    const ArrivalResult result = arrival_of(exchange.two_way(), exchange.trajectory());
    ASSERT_TRUE(result.estimate);
    EXPECT_LT(apart_rad(result.estimate->peaks.front().azimuth_rad, left), 2 * kDegree_rad) << seed;
    for (const ArrivalPeak& peak : result.estimate->peaks) {
      if (std::min(apart_rad(peak.azimuth_rad, left), apart_rad(peak.azimuth_rad, right)) < 3 * kDegree_rad) {
        EXPECT_FALSE(peak.is_ghost) << seed;
      }
      if (apart_rad(peak.azimuth_rad, between) < 5 * kDegree_rad) {
        ++named;
        EXPECT_TRUE(peak.is_ghost) << seed;
        EXPECT_NEAR(std::cos(peak.elevation_rad), std::cos((right - left) / 2), 0.03)
            << "half the sum of two directions is short, as if it came from above";
      }
    }
  }
  EXPECT_GE(named, 3) << "or the test shows nothing";
}

// Lost signs of the square root part a wave in two beside it, whose product then stands where it was.
TEST(ArrivalPaths, AWaveInPartsIsNoProductOfThem) {
  const double left = 20 * kDegree_rad, right = 80 * kDegree_rad;
  SimulatedExchange exchange;
  exchange.motion = metre_of_arc;
  exchange.paths = plane_wave_paths({{left, 0, -15, 3e-8}, {right, 0, -18, 5e-8}});
  int named = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    exchange.seed = seed;
    const ArrivalResult result = arrival_of(exchange.two_way(), exchange.trajectory());
    ASSERT_TRUE(result.estimate);
    for (const ArrivalPeak& peak : result.estimate->peaks)
      if (apart_rad(peak.azimuth_rad, left) < 2 * kDegree_rad && peak.is_ghost) ++named;
  }
  EXPECT_LE(named, 1);
}

TEST(ArrivalPaths, OfOneWaveHaveNoGhost) {
  SimulatedExchange exchange;
  exchange.motion = metre_of_arc;
  exchange.paths = wave_from(0.3);
  const ArrivalResult result = arrival_of(exchange.two_way(), exchange.trajectory());
  ASSERT_TRUE(result.estimate);
  for (const ArrivalPeak& peak : result.estimate->peaks) EXPECT_FALSE(peak.is_ghost);
}

}  // namespace
}  // namespace radioslam
