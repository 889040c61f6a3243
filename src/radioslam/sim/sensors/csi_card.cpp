#include "radioslam/sim/sensors/csi_card.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/base/check.hpp"
#include "radioslam/base/units.hpp"

namespace radioslam {
namespace {

constexpr double kKnot_s = 0.05;  ///< between the knots of a carrier's random walk
constexpr double kFullScale =
    120;  ///< the automatic gain scales the largest number to this; 127 is the maximum
constexpr double kClockWrap_us = 4294967296.0;
constexpr double kPerMillion = 1e-6;
constexpr std::size_t kMaxAntennas = 3;

float rounded(double value) { return static_cast<float>(std::round(value)); }

}  // namespace

CsiCard::CsiCard(const CsiCardParams& params, double end_s, const Rng& rng) {
  Rng carrier = rng.split("carrier"), clock = rng.split("clock"), chains = rng.split("chains");
  offset_hz_.push_back(carrier.normal(0, params.carrier_offset_hz));
  turns_.push_back(0);
  const double step_hz = params.carrier_walk_hz_per_sqrt_s * std::sqrt(kKnot_s);
  while (static_cast<double>(offset_hz_.size() - 1) * kKnot_s < end_s) {
    const double before_hz = offset_hz_.back();
    offset_hz_.push_back(carrier.normal(before_hz, step_hz));
    turns_.push_back(turns_.back() + (before_hz + offset_hz_.back()) / 2 * kKnot_s);
  }
  clock_start_us_ = clock.uniform(0, kClockWrap_us);
  clock_rate_ = 1 + clock.normal(0, params.clock_rate_ppm) * kPerMillion;
  for (std::size_t a = 0; a < kMaxAntennas; ++a)
    chain_phase_rad_.push_back(chains.normal(0, params.sigma_chain_phase_rad));
}

std::size_t CsiCard::knot_before(double t_s) const {
  RADIOSLAM_CHECK(t_s >= 0, "a card starts at time 0");
  return std::min(static_cast<std::size_t>(t_s / kKnot_s), offset_hz_.size() - 1);
}

double CsiCard::carrier_offset_hz(double t_s) const {
  const std::size_t k = knot_before(t_s), next = std::min(k + 1, offset_hz_.size() - 1);
  const double ratio = t_s / kKnot_s - static_cast<double>(k);
  return offset_hz_[k] + (offset_hz_[next] - offset_hz_[k]) * ratio;
}

double CsiCard::carrier_turns(double t_s) const {
  const std::size_t k = knot_before(t_s);
  const double since_s = t_s - static_cast<double>(k) * kKnot_s;
  return turns_[k] + (offset_hz_[k] + carrier_offset_hz(t_s)) / 2 * since_s;
}

std::uint32_t CsiCard::clock_us(double t_s) const {
  const double counted = std::floor(clock_start_us_ + t_s * clock_rate_ * kMicrosecondsPerSecond);
  return static_cast<std::uint32_t>(static_cast<std::uint64_t>(counted));
}

std::complex<double> CsiCard::chain_phase(std::size_t antenna) const {
  return std::polar(1.0, chain_phase_rad_.at(antenna));
}

double noise_power(const CsiCardParams& params) {
  return power_ratio(-params.snr_db) / (params.snr_distance_m * params.snr_distance_m);
}

Eigen::MatrixXcf measured_channel(const Eigen::MatrixXcd& channel, const CsiCardParams& params, Rng rng) {
  const double sigma = std::sqrt(noise_power(params) / 2);
  Eigen::MatrixXcd noisy = channel;
  for (std::complex<double>& value : noisy.reshaped()) {
    const double real = rng.normal(0, sigma), imaginary = rng.normal(0, sigma);
    value += std::complex<double>(real, imaginary);
  }
  const double largest = std::max(noisy.real().cwiseAbs().maxCoeff(), noisy.imag().cwiseAbs().maxCoeff());
  const double gain = largest > 0 ? kFullScale / largest : 1;
  if (!params.quantised) return (gain * noisy).cast<std::complex<float>>();
  return noisy.unaryExpr([gain](const std::complex<double>& value) {
    return std::complex<float>(rounded(gain * value.real()), rounded(gain * value.imag()));
  });
}

}  // namespace radioslam
