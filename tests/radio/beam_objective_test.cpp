#include "radioslam/radio/beam_objective.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "radio/waves.hpp"
#include "radioslam/radio/arrival_array.hpp"
#include "radioslam/radio/arrival_slopes.hpp"

namespace radioslam {
namespace {

using namespace waves;

constexpr double kMostCurvature_per_m = 0.5;
constexpr double kPiece_m = 0.4;

DelayTable delays() { return delay_table(subcarriers()); }

TEST(BeamObjective, IsOneAtANoiselessWaveAndTheSumOfItsShares) {
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
      const WaveSource found = objective.climb({azimuth_rad + off_rad, 0, 0}, 0);
      EXPECT_LT(apart_rad(found.azimuth_rad, azimuth_rad), 1e-5) << azimuth_rad << ' ' << off_rad;
      EXPECT_EQ(found.curvature_per_m, 0);
    }
}

TEST(BeamObjective, ClimbsInCurvatureToo) {
  const Wave wave{{0.9, 0, 0.3}, delays().delay_s(20), 1};
  const BeamObjective objective({array_of({wave}, arc(200, 1, 1.8))}, delays(), wave.source);
  const WaveSource found = objective.climb({0.9 + kDegree_rad / 2, 0, 0.28}, kMostCurvature_per_m);
  EXPECT_LT(apart_rad(found.azimuth_rad, 0.9), 1e-4);
  EXPECT_NEAR(found.curvature_per_m, 0.3, 1e-3);
  const WaveSource held = objective.climb({0.9 + kDegree_rad, 0, 0.1}, 0.2);
  EXPECT_LE(held.curvature_per_m, 0.2);
}

TEST(BeamObjective, NeverStepsDown) {
  Rng rng(11);
  SyntheticArray array = array_of({{{0.9, 0, 0.3}, 0, 1}, {{1.1, 0, 0}, 3e-8, 1}}, arc(120, 0.5, 2));
  array.channel += noise(array.channel.rows(), array.channel.cols(), 1, rng);
  for (int trial = 0; trial < 30; ++trial) {
    const WaveSource from{rng.uniform(-3, 3), 0, rng.uniform(0, 0.5)};
    const BeamObjective objective(subarrays(array, kPiece_m), delays(), from);
    EXPECT_GE(objective.value(objective.climb(from, kMostCurvature_per_m)), objective.value(from));
  }
}

/// How many of a hundred 90 % intervals hold the truth.
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
    const WaveSource peak = objective.climb({azimuth_rad + kDegree_rad / 2, 0, 0}, 0);
    if (apart_rad(peak.azimuth_rad, azimuth_rad) < 1.645 * objective.sigma_rad(peak, 0)) ++count;
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
    const double sigma_rad = objective.sigma_rad(objective.climb(wave.source, 0), 0);
    EXPECT_GT(sigma_rad, 2 * before) << sigma_noise;
    before = sigma_rad;
  }
}

TEST(BeamObjective, SigmaIsTheWidestWhereNothingPeaks) {
  // Beside the peak there is a valley.
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
  EXPECT_NEAR(objective.sigma_rad({valley_rad, 0, 0}, 0), std::numbers::pi / std::sqrt(3.0), 1e-12);
}

}  // namespace
}  // namespace radioslam
