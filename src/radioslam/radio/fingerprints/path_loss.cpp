#include "radioslam/radio/fingerprints/path_loss.hpp"

#include <cmath>

namespace radioslam {
namespace {

constexpr double kMetresPerKilometre = 1000;
constexpr double kFriis_db = 32.44;  // 20 log10(4 pi km MHz / c)
constexpr double kAmplitude_db = 20, kPower_db = 10;

}  // namespace

double free_space_loss_db(double distance_m, double frequency_mhz) {
  return kAmplitude_db * std::log10(distance_m / kMetresPerKilometre) +
         kAmplitude_db * std::log10(frequency_mhz) + kFriis_db;
}

double free_space_distance_m(double loss_db, double frequency_mhz) {
  const double over_1_km_db = kAmplitude_db * std::log10(frequency_mhz) + kFriis_db;
  return kMetresPerKilometre * std::pow(10, (loss_db - over_1_km_db) / kAmplitude_db);
}

double PathLoss::power_dbm(double distance_m) const {
  return power_at_1m_dbm - kPower_db * exponent * std::log10(distance_m);
}

double PathLoss::distance_m(double power_dbm) const {
  return std::pow(10, (power_at_1m_dbm - power_dbm) / (kPower_db * exponent));
}

}  // namespace radioslam
