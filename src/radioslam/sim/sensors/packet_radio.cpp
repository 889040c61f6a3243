#include "radioslam/sim/sensors/packet_radio.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace radioslam {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSpeedOfLight_m_s = 299792458;
constexpr double kBandwidth_Hz = 20e6, kCarrier_Hz = 5.2e9;
constexpr int kSubcarriers = 8;
constexpr double kShortestWave_m = 10, kLongestWave_m = 40;  ///< of shadowing
constexpr double kWeakest_db = -20;                          ///< arrivals below the strongest
constexpr std::size_t kMaxPaths = 4;
constexpr double kSigmaPower_db = 1;
constexpr double kNearest_m = 0.1;

/// SNR of the flat channel that is as good as those of the subcarriers together.
double effective_snr(const std::array<double, kSubcarriers>& snr) {
  const double least = *std::min_element(snr.begin(), snr.end());
  double sum = 0;
  for (const double value : snr) sum += std::exp(least - value);
  return std::max(least - std::log(sum / kSubcarriers), std::numeric_limits<double>::min());
}

}  // namespace

PacketRadio::PacketRadio(const std::vector<WallSegment>& walls, const PacketRadioParams& params,
                         const Rng& rng)
    : walls_(walls), params_(params) {
  for (WallSegment& wall : walls_) {
    wall.reflection = -params.wall_reflection;
    wall.loss_db = params.wall_loss_db;
  }
  Rng draw = rng.split("shadowing");
  for (Wave& wave : waves_) {
    const double direction = draw.uniform(-kPi, kPi);
    const double length_m = draw.uniform(kShortestWave_m, kLongestWave_m);
    wave.wavenumber = 2 * kPi / length_m * Eigen::Vector2d(std::cos(direction), std::sin(direction));
    wave.phase = draw.uniform(-kPi, kPi);
  }
}

double PacketRadio::shadowing_db(const Eigen::Vector2d& place) const {
  double sum = 0;
  for (const Wave& wave : waves_) sum += std::sin(wave.wavenumber.dot(place) + wave.phase);
  // Each of the two ends has half of the variance.
  return params_.sigma_shadowing_db * sum / std::sqrt(static_cast<double>(waves_.size()));
}

PacketReception PacketRadio::receive(const Eigen::Vector2d& transmitter_m, const Eigen::Vector2d& receiver_m,
                                     Rng rng) const {
  const Eigen::Vector3d from(transmitter_m.x(), transmitter_m.y(), 0);
  const Eigen::Vector3d at(receiver_m.x(), receiver_m.y(), 0);
  const double beyond = (params_.path_loss_exponent - 2) / 2;
  PacketReception packet;
  std::array<std::complex<double>, kSubcarriers> channel{};
  for (const RadioPath& path : image_paths(from, at, walls_, {1, 0})) {
    const double length_m = std::max(path.length_m, kNearest_m);
    const double amplitude = path.amplitude * std::pow(length_m, -beyond);
    if (amplitude == 0) continue;
    const double cycles = length_m / kSpeedOfLight_m_s;
    auto wave = std::polar(1.0, -2 * kPi * std::fmod(kCarrier_Hz * cycles, 1.0)) * amplitude;
    const auto turn = std::polar(1.0, -2 * kPi * kBandwidth_Hz / kSubcarriers * cycles);
    for (auto& each : channel) {
      each += wave;
      wave *= turn;
    }
    packet.paths.push_back({std::atan2(path.direction.y(), path.direction.x()),
                            20 * std::log10(std::abs(amplitude)) + rng.normal(0, kSigmaPower_db)});
    packet.paths.back().azimuth_rad += rng.normal(0, params_.sigma_aoa_rad);
  }
  const double gain_db = params_.esnr_1m_db + shadowing_db(transmitter_m) + shadowing_db(receiver_m);
  std::array<double, kSubcarriers> snr{};
  for (int k = 0; k < kSubcarriers; ++k)
    snr[static_cast<std::size_t>(k)] =
        std::pow(10.0, gain_db / 10) * std::norm(channel[static_cast<std::size_t>(k)]);
  packet.esnr_db = 10 * std::log10(effective_snr(snr));
  std::sort(packet.paths.begin(), packet.paths.end(),
            [](const PacketPath& a, const PacketPath& b) { return a.power_db > b.power_db; });
  while (
      packet.paths.size() > kMaxPaths ||
      (packet.paths.size() > 1 && packet.paths.back().power_db < packet.paths.front().power_db + kWeakest_db))
    packet.paths.pop_back();
  for (PacketPath& path : packet.paths) path.power_db += gain_db;
  return packet;
}

}  // namespace radioslam
