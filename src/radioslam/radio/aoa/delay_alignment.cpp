#include "radioslam/radio/aoa/delay_alignment.hpp"

#include <algorithm>

namespace radioslam {
namespace {

constexpr double kStep = 1.0 / 8;                                              // in resolutions of the band
constexpr double kPacketDelays = 5, kWaveDelays = 2.5, kUncentredDelays = 14;  // same unit

double resolution_s(const std::vector<double>& subcarrier_hz) {
  const auto [lowest, highest] = std::minmax_element(subcarrier_hz.begin(), subcarrier_hz.end());
  return 1 / std::max(*highest - *lowest, 1.0);
}

DelayTable delays_up_to(const std::vector<double>& subcarrier_hz, double resolutions, double step) {
  const double one_s = resolution_s(subcarrier_hz);
  return {subcarrier_hz, resolutions * one_s, step * one_s};
}

void advance_all(Eigen::MatrixXcd& channel, const std::vector<double>& subcarrier_hz, double delay_s) {
  for (Eigen::Index k = 0; k < channel.rows(); ++k) {
    Eigen::RowVectorXcd row = channel.row(k);
    advance(row, subcarrier_hz, delay_s);
    channel.row(k) = row;
  }
}

}  // namespace

DelayTable delay_table(const std::vector<double>& subcarrier_hz) {
  return delays_up_to(subcarrier_hz, kWaveDelays, kStep);
}

DelayTable packet_delays(const std::vector<double>& subcarrier_hz) {
  return delays_up_to(subcarrier_hz, kPacketDelays, kStep);
}

std::vector<WavePath> align_delays(MovedArray& one_way, const AoaParams& params) {
  SyntheticArray& array = one_way.array;
  const WaveGrid grid = full_aperture_grid(one_way, params, kWaveAzimuths);
  const auto& hz = array.subcarrier_hz;
  const DelayTable far = delays_up_to(hz, kUncentredDelays, 1.0 / 3), near = delay_table(hz);
  const DelayTable packets = packet_delays(hz);
  std::vector<WavePath> waves;
  for (int pass = 0; pass < params.model_passes; ++pass) {
    const int count = std::min(params.model_paths, 2 + 2 * pass);
    advance_all(array.channel, hz, find_paths(averaged(array), grid, far, 1).front().delay_s);
    waves = find_paths(averaged(array), grid, near, count);
    align_to_model(array.channel, hz, packets, channel_of(waves, array));
  }
  return waves;
}

}  // namespace radioslam
