#include <gtest/gtest.h>

#include <cstring>

#include "radioslam/base/random.hpp"
#include "radioslam/radio/aoa/beamforming.hpp"
#include "radioslam/radio/aoa/delay_alignment.hpp"
#include "radioslam/radio/aoa/steering_sums.hpp"

namespace radioslam {
namespace {

constexpr double kBothWays_radpm = 232;
constexpr Eigen::Index kSnapshots = 300;  // more than one chunk, and no multiple of eight

SyntheticArray random_array(Eigen::Index signals, double height_m) {
  Rng rng(1);
  SyntheticArray array;
  array.wavenumber_radpm = kBothWays_radpm;
  array.positions_m.resize(3, kSnapshots);
  for (double& x : array.positions_m.reshaped()) x = rng.uniform(-0.6, 0.6);
  array.positions_m.row(2) *= height_m;
  array.channel.resize(kSnapshots, signals);
  for (std::complex<double>& h : array.channel.reshaped()) h = {rng.normal(0, 1), rng.normal(0, 1)};
  for (Eigen::Index s = 0; s < signals; ++s) array.subcarrier_hz.push_back(1e6 * static_cast<double>(s));
  return array;
}

std::vector<BeamDirection> random_directions() {
  Rng rng(2);
  std::vector<BeamDirection> directions;
  for (int k = 0; k < 50; ++k) {
    const WaveSource source{rng.uniform(-3, 3), rng.uniform(-1, 1), 0};
    const Eigen::Vector3f u = source.direction().cast<float>();
    directions.push_back({u.x(), u.y(), u.z(), 0});
  }
  return directions;
}

TEST(OppositeBeams, AreWhatEachDirectionHasAlone) {
  const auto ahead = random_directions();
  auto behind = ahead;
  for (BeamDirection& u : behind) u = {-u.x, -u.y, -u.z, 0};
  for (const Eigen::Index signals : {1, 2, 3, 8}) {
    const SyntheticArray array = random_array(signals, 1);
    const BeamInput input = beam_input(array.positions_m, array.wavenumber_radpm, array.channel);
    std::vector<OppositeBeamSums> both(ahead.size());
    std::vector<BeamSum> one(ahead.size()), other(ahead.size());
    opposite_beam_kernel()(input, ahead.data(), ahead.size(), both.data());
    beam_kernel()(input, ahead.data(), ahead.size(), one.data());
    beam_kernel()(input, behind.data(), behind.size(), other.data());
    for (std::size_t k = 0; k < ahead.size(); ++k)
      for (std::size_t r = 0; r < input.signals; ++r) {
        EXPECT_LT(std::abs(both[k].ahead.z[r] - one[k].z[r]), 1e-4F);
        EXPECT_LT(std::abs(both[k].behind.z[r] - other[k].z[r]), 1e-4F);
      }
  }
}

TEST(OppositeBeams, AreTheSameBytesWhateverTheRegisters) {
  const auto directions = random_directions();
  const SyntheticArray array = random_array(7, 1);
  const BeamInput input = beam_input(array.positions_m, array.wavenumber_radpm, array.channel);
  std::vector<OppositeBeamSums> narrow(directions.size()), fastest(directions.size());
  opposite_beam_kernel_sse2()(input, directions.data(), directions.size(), narrow.data());
  opposite_beam_kernel()(input, directions.data(), directions.size(), fastest.data());
  EXPECT_EQ(std::memcmp(narrow.data(), fastest.data(), narrow.size() * sizeof(OppositeBeamSums)), 0);
}

TEST(ArrayBeams, IsWhatDoublesGiveAtEverySource) {
  constexpr Eigen::Index kSubcarriers = 6;
  for (const double height_m : {0.0, 1.0})
    for (const int azimuths : {36, 37}) {
      const SyntheticArray array = random_array(kSubcarriers, height_m);
      const DelayTable delays = delay_table(array.subcarrier_hz);
      const WaveGrid grid{azimuths, {0, 0.3, -0.7}, {0, 0.2}};
      const ArrayBeams beams = array_beams(array, grid, delays);
      const double most = static_cast<double>(kSnapshots * kSubcarriers) * array.channel.squaredNorm();
      for (std::size_t k = 0; k < grid.size(); ++k) {
        Eigen::RowVectorXcd sum = Eigen::RowVectorXcd::Zero(kSubcarriers);
        for (Eigen::Index i = 0; i < kSnapshots; ++i)
          sum += array.channel.row(i) *
                 std::polar(1.0, kBothWays_radpm * excess_path_m(grid.source(k), array.positions_m.col(i)));
        const Eigen::RowVectorXd power = (sum * delays.turns()).cwiseAbs2() / most;
        EXPECT_NEAR(static_cast<double>(beams.power[k]), power.maxCoeff(), 1e-6);
        EXPECT_NEAR(power[beams.best_delay[k]], power.maxCoeff(), 1e-6);
      }
    }
}

}  // namespace
}  // namespace radioslam
