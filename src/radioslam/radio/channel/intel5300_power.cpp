#include "radioslam/radio/channel/intel5300_power.hpp"

#include <cmath>

#include "radioslam/base/units.hpp"
#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

constexpr double kReference_db = 44;
constexpr int kNoiseNotMeasured_dbm = -127;
constexpr double kNominalNoise_dbm = -92;
constexpr double kThreeStreams_db = 4.5;

/// Factor from the power of one stream to the power of all, as the sender splits it among the streams.
double power_of_streams(int streams) {
  if (streams == 1) return 1;
  return streams == 2 ? 2 : power_ratio(kThreeStreams_db);
}

}  // namespace

std::optional<double> received_power_dbm(const CsiPacket& packet) {
  double sum = 0;
  for (const int rssi : packet.rssi)
    if (rssi != 0) sum += power_ratio(rssi);
  if (sum <= 0) return std::nullopt;
  return decibels(sum) - kReference_db - packet.gain_control_db;
}

std::optional<Eigen::MatrixXcd> channel_in_snr_units(const CsiPacket& packet) {
  const auto power_dbm = received_power_dbm(packet);
  const Eigen::MatrixXcd channel = packet.channel.cast<std::complex<double>>();
  const double mean_power = channel.squaredNorm() / static_cast<double>(channel.cols());
  if (!power_dbm || !(mean_power > 0)) return std::nullopt;
  const double scale = power_ratio(*power_dbm) / mean_power;
  const double thermal =
      power_ratio(packet.noise_dbm == kNoiseNotMeasured_dbm ? kNominalNoise_dbm : packet.noise_dbm);
  const double quantisation = scale * packet.antennas * packet.streams;
  return channel * std::sqrt(scale * power_of_streams(packet.streams) / (thermal + quantisation));
}

std::optional<std::vector<double>> subcarrier_snr_db(const CsiPacket& packet) {
  const auto channel = channel_in_snr_units(packet);
  if (!channel) return std::nullopt;
  std::vector<double> snr_db;
  for (Eigen::Index k = 0; k < channel->cols(); ++k) {
    const Eigen::MatrixXcd H =
        channel->col(k).reshaped(packet.antennas, packet.streams) / std::sqrt(packet.streams);
    const Eigen::MatrixXcd gram = H.adjoint() * H;
    const Eigen::MatrixXcd error =
        inverse<Eigen::MatrixXcd>(Eigen::MatrixXcd::Identity(packet.streams, packet.streams) + gram);
    for (int s = 0; s < packet.streams; ++s) {
      // For one stream |h|^2 itself, since 1 / (1 / (1 + x)) - 1 loses a small x to rounding.
      const double snr = packet.streams == 1 ? gram(0, 0).real() : 1 / error(s, s).real() - 1;
      snr_db.push_back(decibels(std::max(0.0, snr)));
    }
  }
  return snr_db;
}

}  // namespace radioslam
