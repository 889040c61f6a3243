#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "phases.hpp"
#include "radioslam/sim/sensors/csi_exchange.hpp"

namespace radioslam {
namespace {

double radians_of(double value) { return value * kPi / 180; }

TEST(CsiChannel, OfOnePathTurnsWithItsLengthAndTheFrequency) {
  const CsiBand band = CsiBand::intel5300(5.54e9);
  ASSERT_EQ(band.subcarrier_hz.size(), 30U);
  for (const double length_m : {0.5, 7.25, 31.0}) {
    const auto channel = channel_of({{length_m, -2 / length_m}}, band);
    for (Eigen::Index k = 0; k < 30; ++k) {
      const double hz = 5.54e9 + band.subcarrier_hz[static_cast<std::size_t>(k)];
      EXPECT_NEAR(std::abs(channel[k]), 2 / length_m, 1e-12);
      EXPECT_NEAR(wrapped(std::arg(-channel[k]) + 2 * kPi * hz * length_m / 299792458.0), 0, 1e-7);
    }
  }
}

TEST(CsiChannel, OfSeveralPathsIsTheirSum) {
  const CsiBand band = CsiBand::intel5300(2.437e9);
  const RadioPath a{3, 0.5}, b{4.7, -0.2};
  EXPECT_LT((channel_of({a, b}, band) - channel_of({a}, band) - channel_of({b}, band)).norm(), 1e-12);
  EXPECT_EQ(channel_of({}, band).norm(), 0);
}

TEST(CsiChannel, PlaneWavesTurnWithThePathTowardsTheirSource) {
  const PlaneWave wave{radians_of(40), radians_of(20), -6, 30e-9};
  const auto paths = plane_wave_paths({wave});
  const CsiBand band{5.54e9, {0}, 20e6};
  const Eigen::Vector3d here(1, 2, 3), step(0.013, -0.02, 0.005), anywhere(9, 9, 9);
  const double wavelength_m = 299792458.0 / 5.54e9;
  const Eigen::Vector3d u(std::cos(wave.elevation_rad) * std::cos(wave.azimuth_rad),
                          std::cos(wave.elevation_rad) * std::sin(wave.azimuth_rad),
                          std::sin(wave.elevation_rad));
  const auto before = channel_of(paths(here, anywhere), band)[0];
  const auto after = channel_of(paths(here + step, -anywhere), band)[0];
  EXPECT_NEAR(wrapped(std::arg(after / before) - 2 * kPi / wavelength_m * step.dot(u)), 0, 1e-7);
  EXPECT_NEAR(std::norm(before), std::pow(10, -0.6), 1e-9);
  const auto origin = channel_of(paths({0, 0, 0}, anywhere), band)[0];
  EXPECT_NEAR(wrapped(std::arg(origin) + 2 * kPi * 5.54e9 * 30e-9), 0, 1e-6);
}

/// Power of a direction over snapshots along an arc, by steering vectors a_k = exp(+j 2 pi / lambda delta u).
double power_from(double azimuth_rad, const std::vector<Eigen::Vector3d>& places,
                  const std::vector<std::complex<double>>& snapshots, double wavelength_m) {
  const Eigen::Vector3d u(std::cos(azimuth_rad), std::sin(azimuth_rad), 0);
  std::complex<double> sum = 0;
  for (std::size_t k = 0; k < places.size(); ++k)
    sum += std::polar(1.0, -2 * kPi / wavelength_m * places[k].dot(u)) * snapshots[k];
  return std::abs(sum) / static_cast<double>(places.size());
}

TEST(CsiChannel, ThreeWavesOnAnArcOfAMetreComeFromWhereTheyShould) {
  const double wavelength_m = 299792458.0 / 5.54e9;
  std::vector<PlaneWave> waves;
  for (const double azimuth_deg : {60.0, 85.0, 110.0}) waves.push_back({radians_of(azimuth_deg), 0, 0, 0});
  const auto paths = plane_wave_paths(waves);
  std::vector<Eigen::Vector3d> places;
  std::vector<std::complex<double>> snapshots;
  for (int k = 0; k <= 200; ++k) {
    const double angle = k / 200.0 * 2;  // an arc of 1 m around a circle of 0.5 m
    places.emplace_back(0.5 * std::cos(angle), 0.5 * std::sin(angle), 0);
    snapshots.push_back(channel_of(paths(places.back(), {}), {5.54e9, {0}, 20e6})[0]);
  }
  const auto power = [&](double azimuth_deg) {
    return power_from(radians_of(azimuth_deg), places, snapshots, wavelength_m);
  };
  for (const double azimuth_deg : {60.0, 85.0, 110.0}) EXPECT_NEAR(power(azimuth_deg), 1, 0.35);
  for (const double azimuth_deg : {-60.0, 0.0, 30.0, 150.0, 180.0}) EXPECT_LT(power(azimuth_deg), 0.4);
}

}  // namespace
}  // namespace radioslam
