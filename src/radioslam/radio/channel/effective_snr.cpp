#include "radioslam/radio/channel/effective_snr.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "radioslam/base/check.hpp"
#include "radioslam/base/units.hpp"

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

}  // namespace radioslam
