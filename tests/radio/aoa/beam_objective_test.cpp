#include "radioslam/radio/aoa/beam_objective.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "radio/aoa/waves.hpp"
#include "radioslam/radio/aoa/aoa_array.hpp"
#include "radioslam/radio/aoa/delay_alignment.hpp"

namespace radioslam {
namespace {

using namespace waves;

constexpr SourceBounds kBent{0.5, 0, 0};
constexpr double kPiece_m = 0.4;

DelayTable delays() { return delay_table(subcarriers()); }

TEST(BeamObjective, IsOneAtANoiselessWaveAndTheSumOfItsBlocks) {
  const Wave wave{{0.7, 0.1, 0.2}, delays().delay_s(22), 3};
  const auto pieces = subarrays(array_of({wave}, arc(120, 0.5, 2)), kPiece_m);
  ASSERT_GT(pieces.size(), 2U);
  const BeamObjective objective(pieces, delays(), wave.source);
  EXPECT_NEAR(objective.value(wave.source), 1, 1e-9);
  const WaveSource beside{0.75, 0.1, 0};
  const auto shares = objective.shares(beside);
  EXPECT_NEAR(std::accumulate(shares.begin(), shares.end(), 0.0), objective.value(beside), 1e-12);
  EXPECT_LT(objective.value(beside), 1);
}

TEST(BeamObjective, ClimbsToTheTrueAzimuthFromADegreeOff) {
  for (const double azimuth_rad : {-3.1, -1.2, 0.3, 2.2})
    for (const double off_rad : {-kDegree_rad, kDegree_rad}) {
      const Wave wave{{azimuth_rad, 0, 0}, delays().delay_s(20), 1};
      const BeamObjective objective({array_of({wave}, arc(120, 0.5, 2))}, delays(), wave.source);
      const WaveSource found = objective.climb({azimuth_rad + off_rad, 0, 0}, {});
      EXPECT_LT(apart_rad(found.azimuth_rad, azimuth_rad), 1e-5) << azimuth_rad << ' ' << off_rad;
      EXPECT_EQ(found.curvature_per_m, 0);
    }
}

TEST(BeamObjective, ClimbsInCurvatureToo) {
  const Wave wave{{0.9, 0, 0.3}, delays().delay_s(20), 1};
  const BeamObjective objective({array_of({wave}, arc(200, 1, 1.8))}, delays(), wave.source);
  const WaveSource found = objective.climb({0.9 + kDegree_rad / 2, 0, 0.28}, kBent);
  EXPECT_LT(apart_rad(found.azimuth_rad, 0.9), 1e-4);
  EXPECT_NEAR(found.curvature_per_m, 0.3, 1e-3);
  const WaveSource held = objective.climb({0.9 + kDegree_rad, 0, 0.1}, {0.2, 0, 0});
  EXPECT_LE(held.curvature_per_m, 0.2);
}

TEST(BeamObjective, ClimbsInElevationToo) {
  Eigen::Matrix3Xd helix = arc(200, 0.3, 5);
  for (Eigen::Index k = 0; k < helix.cols(); ++k) helix(2, k) = 0.002 * (static_cast<double>(k) - 99.5);
  for (const double elevation_rad : {-0.4, 0.0, 0.25}) {
    const BeamObjective objective({array_of({{{0.9, elevation_rad, 0}, 0, 1}}, helix)}, delays(),
                                  {0.9, elevation_rad, 0});
    const SourceBounds bounds{0, -0.7, 0.7};
    const WaveSource found = objective.climb({0.9 + kDegree_rad, elevation_rad + 2 * kDegree_rad, 0}, bounds);
    EXPECT_LT(apart_rad(found.azimuth_rad, 0.9), 1e-4) << elevation_rad;
    EXPECT_NEAR(found.elevation_rad, elevation_rad, 1e-4);
    const WaveSource held = objective.climb({0.9, 0.1, 0}, {0, 0.1, 0.1});
    EXPECT_EQ(held.elevation_rad, 0.1);
    EXPECT_EQ(objective.sigma(held, {0, 0.1, 0.1}).elevation_rad, std::numbers::pi / std::sqrt(3.0));
  }
}

TEST(BeamObjective, NothingBesideAPeakIsHigher) {
  Rng rng(14);
  SyntheticArray array = array_of({{{0.9, 0.2, 0.3}, 0, 1}}, arc(60, 0.5, 2));
  array.channel += noise(array.channel.rows(), array.channel.cols(), 2, rng);
  const BeamObjective objective(subarrays(array, kPiece_m), delays(), {0.9, 0.2, 0.3});
  // At the peak no small step in any coordinate increases the objective.
  const SourceBounds bounds{0.5, 0, 0.7};
  const WaveSource peak = objective.climb({0.9, 0.2, 0.3}, bounds);
  constexpr double kSmall = 1e-3;
  for (const double way : {-kSmall, kSmall}) {
    EXPECT_LE(objective.value({peak.azimuth_rad + way, peak.elevation_rad, peak.curvature_per_m}),
              objective.value(peak) + 1e-9);
    if (peak.elevation_rad > kSmall && peak.elevation_rad < 0.7 - kSmall) {
      EXPECT_LE(objective.value({peak.azimuth_rad, peak.elevation_rad + way, peak.curvature_per_m}),
                objective.value(peak) + 1e-9);
    }
    if (peak.curvature_per_m > kSmall && peak.curvature_per_m < 0.5 - kSmall) {
      EXPECT_LE(objective.value({peak.azimuth_rad, peak.elevation_rad, peak.curvature_per_m + way}),
                objective.value(peak) + 1e-9);
    }
  }
}

TEST(BeamObjective, NeverStepsDown) {
  Rng rng(11);
  SyntheticArray array = array_of({{{0.9, 0, 0.3}, 0, 1}, {{1.1, 0, 0}, 3e-8, 1}}, arc(120, 0.5, 2));
  array.channel += noise(array.channel.rows(), array.channel.cols(), 1, rng);
  for (int trial = 0; trial < 30; ++trial) {
    const WaveSource from{rng.uniform(-3, 3), 0, rng.uniform(0, 0.5)};
    const BeamObjective objective(subarrays(array, kPiece_m), delays(), from);
    EXPECT_GE(objective.value(objective.climb(from, kBent)), objective.value(from));
  }
}

/// Number of 90 % intervals, of a hundred, that contain the truth.
int held(double piece_m, double sigma_noise, double azimuth_rad) {
  const Wave wave{{azimuth_rad, 0, 0}, 0, 1};
  const SyntheticArray clean = array_of({wave}, arc(120, 0.5, 2));
  const Rng rng(12);
  int count = 0;
  for (std::uint64_t trial = 0; trial < 100; ++trial) {
    Rng own = rng.split(trial);
    SyntheticArray array = clean;
    array.channel += noise(array.channel.rows(), array.channel.cols(), sigma_noise, own);
    const BeamObjective objective(subarrays(array, piece_m), delays(), wave.source);
    const WaveSource peak = objective.climb({azimuth_rad + kDegree_rad / 2, 0, 0}, {});
    if (apart_rad(peak.azimuth_rad, azimuth_rad) < 1.645 * objective.sigma(peak, {}).azimuth_rad) ++count;
  }
  return count;
}

TEST(BeamObjective, NineOfTenIntervalsHoldTheTruth) {
  for (const double sigma_noise : {0.5, 3.0})
    for (const double azimuth_rad : {0.4, 2.5}) {
      const int count = held(kPiece_m, sigma_noise, azimuth_rad);
      EXPECT_GE(count, 80) << sigma_noise << ' ' << azimuth_rad;
      EXPECT_LE(count, 97) << sigma_noise << ' ' << azimuth_rad;
    }
}

TEST(BeamObjective, SigmaGrowsWithTheNoise) {
  const Wave wave{{0.4, 0, 0}, 0, 1};
  double before = 0;
  for (const double sigma_noise : {0.1, 1.0, 5.0}) {
    Rng rng(13);
    SyntheticArray array = array_of({wave}, arc(120, 0.5, 2));
    array.channel += noise(array.channel.rows(), array.channel.cols(), sigma_noise, rng);
    const BeamObjective objective(subarrays(array, kPiece_m), delays(), wave.source);
    const double sigma_rad = objective.sigma(objective.climb(wave.source, {}), {}).azimuth_rad;
    EXPECT_GT(sigma_rad, 2 * before) << sigma_noise;
    before = sigma_rad;
  }
}

TEST(BeamObjective, SigmaIsTheWidestWhereNothingPeaks) {
  // Next to the peak is a valley.
  const SyntheticArray array = array_of({{{0.5, 0, 0}, 0, 1}}, arc(120, 0.5, 2));
  const BeamObjective objective({array}, delays(), {0.5, 0, 0});
  double valley_rad = 0.5, least = 1;
  for (double azimuth_rad = 0.5; azimuth_rad < 0.7; azimuth_rad += 1e-3) {
    const double value = objective.value({azimuth_rad, 0, 0});
    if (value < least) {
      least = value;
      valley_rad = azimuth_rad;
    }
  }
  EXPECT_NEAR(objective.sigma({valley_rad, 0, 0}, {}).azimuth_rad, std::numbers::pi / std::sqrt(3.0), 1e-12);
}

}  // namespace
}  // namespace radioslam
