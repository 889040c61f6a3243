#include "radioslam/radio/intel5300_power.hpp"

#include <Eigen/LU>
#include <cmath>

namespace radioslam {
namespace {

constexpr double kReference_db = 44;
constexpr int kNoiseNotMeasured_dbm = -127;
constexpr double kUsualNoise_dbm = -92;
constexpr double kThreeStreams_db = 4.5;

double linear(double db) { return std::pow(10, db / 10); }

/// What the receiver sees of the whole power where each stream is sent with its share.
double power_of_streams(int streams) {
  if (streams == 1) return 1;
  return streams == 2 ? 2 : linear(kThreeStreams_db);
}

}  // namespace

std::optional<double> received_power_dbm(const CsiPacket& packet) {
  double sum = 0;
  for (const int rssi : packet.rssi)
    if (rssi != 0) sum += linear(rssi);
  if (sum <= 0) return std::nullopt;
  return 10 * std::log10(sum) - kReference_db - packet.gain_control_db;
}

std::optional<Eigen::MatrixXcd> channel_in_snr_units(const CsiPacket& packet) {
  const auto power_dbm = received_power_dbm(packet);
  const Eigen::MatrixXcd channel = packet.channel.cast<std::complex<double>>();
  const double mean_power = channel.squaredNorm() / static_cast<double>(channel.cols());
  if (!power_dbm || !(mean_power > 0)) return std::nullopt;
  const double scale = linear(*power_dbm) / mean_power;
  const double thermal =
      linear(packet.noise_dbm == kNoiseNotMeasured_dbm ? kUsualNoise_dbm : packet.noise_dbm);
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
        (Eigen::MatrixXcd::Identity(packet.streams, packet.streams) + gram).inverse();
    for (int s = 0; s < packet.streams; ++s) {
      // One stream: |h|^2 itself, since 1 / (1 / (1 + x)) - 1 loses a small x.
      const double snr = packet.streams == 1 ? gram(0, 0).real() : 1 / error(s, s).real() - 1;
      snr_db.push_back(10 * std::log10(std::max(0.0, snr)));
    }
  }
  return snr_db;
}

}  // namespace radioslam
