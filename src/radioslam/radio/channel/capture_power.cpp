#include "radioslam/radio/channel/capture_power.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "radioslam/base/check.hpp"
#include "radioslam/base/statistics.hpp"
#include "radioslam/base/units.hpp"
#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

constexpr double kMin_db = -300;        // below it, the BER equals that without signal
constexpr double kAsymptoticFrom = 30;  // the series' first neglected term is 945 / x^10: 2e-12
constexpr int kHalvings = 60;           // bisections of an interval of 400 dB, down to rounding

/// BER(rho) = factor Q(sqrt(gain rho)).
struct ErrorRate {
  double factor = 1, gain = 1;
};

ErrorRate error_rate(Modulation modulation) {
  switch (modulation) {
    case Modulation::kBpsk:
      return {1, 2};
    case Modulation::kQpsk:
      return {1, 1};
    case Modulation::kQam16:
      return {3.0 / 4, 1.0 / 5};
    case Modulation::kQam64:
      return {7.0 / 12, 1.0 / 21};
  }
  return {};
}

/// log of the normal distribution's upper tail, x >= 0 (Abramowitz & Stegun 26.2.12 for large x).
double log_tail(double x) {
  if (x < kAsymptoticFrom) return std::log(std::erfc(x / std::numbers::sqrt2) / 2);
  const double y = 1 / (x * x);
  return -x * x / 2 - std::log(x * std::sqrt(2 * std::numbers::pi)) +
         std::log1p(-y * (1 - y * (3 - y * (15 - 105 * y))));
}

/// log of the mean of exp(values).
double log_mean_exp(const std::vector<double>& values) {
  const double largest = *std::max_element(values.begin(), values.end());
  double sum = 0;
  for (const double value : values) sum += std::exp(value - largest);
  return largest + std::log(sum / static_cast<double>(values.size()));
}

constexpr double kReference_db = 44;
constexpr int kNoiseNotMeasured_dbm = -127;
constexpr double kNominalNoise_dbm = -92;
constexpr double kThreeStreams_db = 4.5;

/// Factor from the power of one stream to the power of all, as the sender splits it among the streams.
double power_of_streams(int streams) {
  if (streams == 1) return 1;
  return streams == 2 ? 2 : power_ratio(kThreeStreams_db);
}

constexpr std::size_t kMaxPackets = 200;

struct NamedModulation {
  const char* name;
  Modulation modulation;
};

constexpr std::array<NamedModulation, 4> kModulations{{{"bpsk", Modulation::kBpsk},
                                                       {"qpsk", Modulation::kQpsk},
                                                       {"qam16", Modulation::kQam16},
                                                       {"qam64", Modulation::kQam64}}};

std::optional<double> middle_of(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  return upper_median(std::move(values));
}

bool is_in_dbm(const CsiPacket& packet) {
  return std::any_of(packet.rssi.begin(), packet.rssi.end(), [](int rssi) { return rssi < 0; });
}

std::optional<double> power_dbm(const CsiPacket& packet) {
  if (!is_in_dbm(packet)) return received_power_dbm(packet);
  double sum_mw = 0;
  for (const int rssi : packet.rssi)
    if (rssi != 0) sum_mw += std::pow(10, rssi / 10.0);
  return decibels(sum_mw);
}

}  // namespace

double log_bit_error_rate(double snr_db, Modulation modulation) {
  const auto [factor, gain] = error_rate(modulation);
  return std::log(factor) + log_tail(std::sqrt(gain * power_ratio(snr_db)));
}

double effective_snr_db(std::span<const double> snr_db, Modulation modulation) {
  RADIOSLAM_CHECK(!snr_db.empty(), "an effective SNR needs at least one subcarrier");
  std::vector<double> log_rates;
  for (const double snr : snr_db) {
    RADIOSLAM_CHECK(snr < std::numeric_limits<double>::infinity(), "an SNR is finite or -infinity");
    log_rates.push_back(log_bit_error_rate(snr, modulation));
  }
  const double target = log_mean_exp(log_rates);
  const auto [least, most] = std::minmax_element(snr_db.begin(), snr_db.end());
  if (*most < kMin_db) return -std::numeric_limits<double>::infinity();
  double low = std::max(*least, kMin_db), high = *most;
  for (int k = 0; k < kHalvings && low < high; ++k) {
    const double middle = low + (high - low) / 2;
    (log_bit_error_rate(middle, modulation) > target ? low : high) = middle;
  }
  return low + (high - low) / 2;
}

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

CapturePower capture_power(const CsiCapture& capture, std::optional<MacAddress> sender) {
  std::vector<const CsiPacket*> packets;
  for (const CsiPacket& packet : capture.packets)
    if (!sender || packet.sender == sender) packets.push_back(&packet);
  std::vector<double> powers_dbm;
  std::array<std::vector<double>, kModulations.size()> snrs_db;
  const std::size_t counted = std::min(packets.size(), kMaxPackets);
  for (std::size_t k = 0; k < counted; ++k) {
    const CsiPacket& packet = *packets[k * packets.size() / counted];
    if (const auto power = power_dbm(packet)) powers_dbm.push_back(*power);
    if (is_in_dbm(packet)) continue;
    const auto subcarriers_db = subcarrier_snr_db(packet);
    if (!subcarriers_db) continue;
    for (std::size_t m = 0; m < kModulations.size(); ++m)
      snrs_db[m].push_back(effective_snr_db(*subcarriers_db, kModulations[m].modulation));
  }
  CapturePower power{packets.size(), middle_of(std::move(powers_dbm)), {}};
  for (std::size_t m = 0; m < kModulations.size(); ++m)
    if (const auto snr_db = middle_of(std::move(snrs_db[m])))
      power.effective_snr_db.emplace_back(kModulations[m].name, *snr_db);
  return power;
}

}  // namespace radioslam
