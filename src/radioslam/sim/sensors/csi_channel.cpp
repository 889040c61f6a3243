#include "radioslam/sim/sensors/csi_channel.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include "radioslam/geometry/direction.hpp"
#include "radioslam/mission/wifi_channel.hpp"

namespace radioslam {

CsiBand CsiBand::intel5300(double carrier_hz) {
  return {carrier_hz, grouped_subcarriers_hz(ChannelWidth::k20MHz), 20e6};
}

Eigen::RowVectorXcd channel_of(const std::vector<RadioPath>& paths, const CsiBand& band) {
  Eigen::RowVectorXcd channel = Eigen::RowVectorXcd::Zero(std::ssize(band.subcarrier_hz));
  for (const RadioPath& path : paths) {
    const double delay_s = path.length_m / kLightSpeed_mps;
    for (Eigen::Index k = 0; k < channel.size(); ++k) {
      const double turns = (band.carrier_hz + band.subcarrier_hz[static_cast<std::size_t>(k)]) * delay_s;
      const double phase = -2 * std::numbers::pi * (turns - std::floor(turns));
      channel[k] += path.amplitude * std::complex<double>(std::cos(phase), std::sin(phase));
    }
  }
  return channel;
}

PathsBetween plane_wave_paths(std::vector<PlaneWave> waves) {
  return [waves = std::move(waves)](const Eigen::Vector3d& here_m, const Eigen::Vector3d& /*there_m*/) {
    std::vector<RadioPath> paths;
    for (const PlaneWave& wave : waves) {
      const Eigen::Vector3d from = unit_direction(wave.azimuth_rad, wave.elevation_rad);
      paths.push_back(
          {wave.delay_s * kLightSpeed_mps - from.dot(here_m), std::pow(10, wave.power_db / 20), 0, from});
    }
    return paths;
  };
}

PathsBetween room_paths(std::vector<WallSegment> walls, const ImageParams& params) {
  return [walls = std::move(walls), params](const Eigen::Vector3d& here_m, const Eigen::Vector3d& there_m) {
    return image_paths(there_m, here_m, walls, params);
  };
}

}  // namespace radioslam
