#include "radioslam/radio/aoa/multipath_model.hpp"

#include <gtest/gtest.h>

#include "radio/aoa/waves.hpp"
#include "radioslam/radio/aoa/delay_alignment.hpp"

namespace radioslam {
namespace {

using namespace waves;

WaveGrid level_grid() {
  WaveGrid grid;
  grid.azimuths = 180;
  grid.curvatures_per_m = {0, 0.4};
  return grid;
}

/// Waves on the grid, far enough apart to be resolved, strongest first.
std::vector<Wave> three_waves(const WaveGrid& grid, const DelayTable& delays) {
  return {{grid.source(60), delays.delay_s(20), {1, 0}},
          {grid.source(120), delays.delay_s(25), {0, 0.6}},
          {grid.source(180 + 5), delays.delay_s(30), {-0.3, 0.2}}};
}

TEST(PathModel, RecoversThreeWaves) {
  const WaveGrid grid = level_grid();
  const DelayTable delays = delay_table(subcarriers());
  const auto truth = three_waves(grid, delays);
  const auto paths = find_paths(array_of(truth, arc(120, 0.6, 2.5)), grid, delays, 3);
  ASSERT_EQ(paths.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(paths[i].source.azimuth_rad, truth[i].source.azimuth_rad, 1e-9) << i;
    EXPECT_NEAR(paths[i].source.curvature_per_m, truth[i].source.curvature_per_m, 1e-9) << i;
    EXPECT_NEAR(paths[i].delay_s, truth[i].delay_s, 1e-12) << i;
    EXPECT_LT(std::abs(paths[i].amplitude - truth[i].amplitude), 1e-6) << i;
  }
}

TEST(PathModel, IsTheChannelThatItsWavesMake) {
  const WaveGrid grid = level_grid();
  const DelayTable delays = delay_table(subcarriers());
  const auto truth = three_waves(grid, delays);
  std::vector<WavePath> paths;
  for (const Wave& wave : truth) paths.push_back({wave.source, wave.delay_s, wave.amplitude});
  const SyntheticArray array = array_of(truth, arc(50, 0.6, 2.5));
  EXPECT_LT((channel_of(paths, array) - array.channel).norm(), 1e-9);
  EXPECT_EQ(channel_of({}, array).norm(), 0);
}

TEST(PathModel, EveryWaveMoreLeavesLess) {
  const WaveGrid grid = level_grid();
  const DelayTable delays = delay_table(subcarriers());
  Rng rng(9);
  SyntheticArray array = array_of(
      {{{1.003, 0.2, 0.1}, 1e-8, 1}, {{-1.7, 0, 0}, 3.3e-8, 0.8}, {{3, 0.1, 0.3}, 0, 0.5}}, arc(80, 0.5, 2));
  array.channel += noise(array.channel.rows(), array.channel.cols(), 0.1, rng);
  double before = array.channel.norm();
  for (int count = 1; count <= 8; ++count) {
    const Eigen::MatrixXcd rest = array.channel - channel_of(find_paths(array, grid, delays, count), array);
    EXPECT_LT(rest.norm(), before) << count;
    before = rest.norm();
  }
  EXPECT_LT(before, 0.35 * array.channel.norm());
}

TEST(PathModel, WhatItLeavesIsOrthogonalToItsWaves) {
  const WaveGrid grid = level_grid();
  const DelayTable delays = delay_table(subcarriers());
  Rng rng(10);
  SyntheticArray array = array_of({{{1.003, 0, 0}, 1e-8, 1}, {{1.3, 0, 0}, 3.3e-8, 0.8}}, arc(80, 0.5, 2));
  array.channel += noise(array.channel.rows(), array.channel.cols(), 0.3, rng);
  const auto paths = find_paths(array, grid, delays, 4);
  const Eigen::MatrixXcd rest = array.channel - channel_of(paths, array);
  for (WavePath path : paths) {
    path.amplitude = 1;
    const std::complex<double> along = channel_of({path}, array).conjugate().cwiseProduct(rest).sum();
    EXPECT_LT(std::abs(along), 1e-6 * array.channel.norm());
  }
}

}  // namespace
}  // namespace radioslam
