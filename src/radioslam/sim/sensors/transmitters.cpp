#include "radioslam/sim/sensors/transmitters.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "radioslam/base/check.hpp"

namespace radioslam {
namespace {

constexpr double kReferenceFrequency_mhz = 2437;
constexpr double kReferenceDistance_m = 1;
constexpr std::array<double, 3> kChannels2_mhz{2412, 2437, 2462};
constexpr std::array<double, 6> kChannels5_mhz{5180, 5200, 5220, 5240, 5745, 5785};

/// A device with one or two radios.
struct Device {
  Eigen::Vector3d position;
  double power_at_1m_dbm = 0;
  double exponent = 0;
};

template <std::size_t kCount>
double draw_from(const std::array<double, kCount>& values, Rng& rng) {
  return values[rng.below(kCount)];
}

/// Locally administered address; the last two bytes count, the middle three are random.
std::string bssid(std::size_t number, Rng& rng) {
  constexpr std::string_view digits = "0123456789abcdef";
  const std::uint64_t value = (rng.below(1U << 24U) << 16U) | (number & 0xffffU);
  std::string text = "02";
  for (int shift = 36; shift >= 0; shift -= 8)
    text += {':', digits[(value >> static_cast<unsigned>(shift)) & 15U],
             digits[(value >> static_cast<unsigned>(shift - 4)) & 15U]};
  return text;
}

/// Half along the outer walls, half anywhere on the ceiling.
Eigen::Vector2d draw_inside(const LaneGridParams& floor, Rng& rng) {
  // One after the other: compilers evaluate arguments in different orders.
  const double y = rng.uniform(0, floor.floor_y_m), x = rng.uniform(0, floor.floor_x_m);
  Eigen::Vector2d p(x, y);
  switch (rng.below(8)) {
    case 0:
      p.x() = 0;
      break;
    case 1:
      p.x() = floor.floor_x_m;
      break;
    case 2:
      p.y() = 0;
      break;
    case 3:
      p.y() = floor.floor_y_m;
      break;
    default:
      break;
  }
  return p;
}

Eigen::Vector2d draw_outside(const LaneGridParams& floor, double reach_m, Rng& rng) {
  for (;;) {
    const double y = rng.uniform(-reach_m, floor.floor_y_m + reach_m);
    const double x = rng.uniform(-reach_m, floor.floor_x_m + reach_m);
    const Eigen::Vector2d p(x, y);
    const bool inside = p.x() >= 0 && p.x() <= floor.floor_x_m && p.y() >= 0 && p.y() <= floor.floor_y_m;
    if (!inside) return p;
  }
}

Device draw_device(const LaneGridParams& floor, const TransmitterParams& params, Rng& rng) {
  const bool outside = rng.uniform() < params.outside_ratio;
  const Eigen::Vector2d p =
      outside ? draw_outside(floor, params.max_outside_m, rng) : draw_inside(floor, rng);
  Device device;
  device.position = {p.x(), p.y(), params.ceiling_m};
  device.power_at_1m_dbm = rng.normal(params.mean_power_at_1m_dbm, params.sigma_power_at_1m_db) -
                           (outside ? params.outside_loss_db : 0);
  device.exponent = rng.normal(params.mean_exponent, params.sigma_exponent);
  return device;
}

Transmitter make_radio(const Device& device, double frequency_mhz, std::size_t number,
                       const TransmitterParams& params, const Rng& rng) {
  Rng name = rng.split("bssid");
  return Transmitter(bssid(number, name), device.position, frequency_mhz, device.power_at_1m_dbm,
                     device.exponent,
                     ShadowingField(params.sigma_shadowing_db, params.shadowing_length_m,
                                    params.shadowing_waves, rng.split("shadowing")));
}

}  // namespace

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

Transmitter::Transmitter(std::string bssid, Eigen::Vector3d position, double frequency_mhz,
                         double power_at_1m_dbm, double exponent, ShadowingField shadowing)
    : bssid_(std::move(bssid)),
      position_(std::move(position)),
      frequency_mhz_(frequency_mhz),
      power_at_1m_dbm_(power_at_1m_dbm),
      exponent_(exponent),
      shadowing_(std::move(shadowing)) {}

double Transmitter::mean_power_dbm(const Eigen::Vector3d& receiver) const {
  const double distance_m = std::max((receiver - position_).norm(), kReferenceDistance_m);
  return power_at_1m_dbm_ - 20 * std::log10(frequency_mhz_ / kReferenceFrequency_mhz) -
         10 * exponent_ * std::log10(distance_m / kReferenceDistance_m) +
         shadowing_.at_db(receiver.head<2>());
}

std::vector<Transmitter> place_transmitters(const LaneGridParams& floor, const TransmitterParams& params,
                                            const Rng& rng) {
  const auto count = static_cast<std::size_t>(params.access_points);
  std::vector<Transmitter> radios;
  for (std::size_t i = 0; radios.size() < count; ++i) {
    const Rng own = rng.split(i);
    Rng draw = own.split("device");
    const Device device = draw_device(floor, params, draw);
    const double low_mhz = draw_from(kChannels2_mhz, draw);
    const double high_mhz = draw_from(kChannels5_mhz, draw);
    const bool high_first = draw.uniform() < params.band_5ghz_ratio;
    const bool dual = draw.uniform() < params.dual_band_ratio;
    radios.push_back(
        make_radio(device, high_first ? high_mhz : low_mhz, radios.size(), params, own.split("first")));
    if (dual && radios.size() < count)
      radios.push_back(
          make_radio(device, high_first ? low_mhz : high_mhz, radios.size(), params, own.split("second")));
  }
  std::sort(radios.begin(), radios.end(),
            [](const Transmitter& a, const Transmitter& b) { return a.bssid() < b.bssid(); });
  return radios;
}

}  // namespace radioslam
