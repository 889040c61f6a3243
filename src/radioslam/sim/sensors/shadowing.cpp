#include "radioslam/sim/sensors/shadowing.hpp"

#include <cmath>
#include <numbers>

#include "radioslam/base/check.hpp"

namespace radioslam {

ShadowingField::ShadowingField(double sigma_db, double correlation_length_m, int waves, Rng rng) {
  RADIOSLAM_CHECK(waves > 0 && correlation_length_m > 0, "shadowing needs a wave and a length");
  amplitude_db_ = sigma_db * std::sqrt(2.0 / waves);
  for (int i = 0; i < waves; ++i) {
    const double above = 1 - rng.uniform();  // in (0, 1]
    const double wavenumber = std::sqrt(1 / (above * above) - 1) / correlation_length_m;
    const double direction = rng.uniform(0, 2 * std::numbers::pi);
    const double phase = rng.uniform(0, 2 * std::numbers::pi);
    waves_.push_back({wavenumber * Eigen::Vector2d(std::cos(direction), std::sin(direction)), phase});
  }
}

double ShadowingField::at_db(const Eigen::Vector2d& position) const {
  double sum = 0;
  for (const auto& wave : waves_) sum += std::cos(wave.wavenumber_per_m.dot(position) + wave.phase_rad);
  return amplitude_db_ * sum;
}

}  // namespace radioslam
