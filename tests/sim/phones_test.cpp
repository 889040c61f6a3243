#include "radioslam/sim/sensors/phones.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace radioslam {
namespace {

SE2 standing(double) { return SE2({10, 0}, 0); }

/// One radio, received with exactly `power_dbm` at the robot's position.
std::vector<Transmitter> radio_heard_with(double power_dbm) {
  return {Transmitter("02:00:00:00:00:01", {10, 0, 0}, 2437, power_dbm, 2, ShadowingField(0, 7, 1, Rng(1)))};
}

PhoneParams plain() {
  PhoneParams params;
  params.sigma_phone_offset_db = params.sigma_fading_db = 0;
  params.missed_scan_ratio = 0;
  return params;
}

TEST(Phones, ScanAtTheirRate) {
  const auto scans = simulate_scans(standing, 0, 1000, radio_heard_with(-40), 0, plain(), Rng(1));
  EXPECT_NEAR(static_cast<double>(scans.size()), 5 * 0.5 * 1000, 5);
  EXPECT_GE(scans.front().stamp.ns, 0);
  EXPECT_LE(scans.back().stamp, Stamp::from_seconds(1000));
}

TEST(Phones, MissTheRequestedRatio) {
  PhoneParams params = plain();
  params.missed_scan_ratio = 0.2;
  const auto scans = simulate_scans(standing, 0, 1000, radio_heard_with(-40), 0, params, Rng(1));
  EXPECT_NEAR(static_cast<double>(scans.size()), 2000, 5 * std::sqrt(2500 * 0.2 * 0.8) + 5);
}

TEST(Phones, StampScansInOrderAndOneByOne) {
  PhoneParams params = plain();
  params.phones = 50;
  params.scan_rate_hz = 10;
  const auto scans = simulate_scans(standing, 0, 20, radio_heard_with(-40), 0, params, Rng(1));
  for (std::size_t i = 0; i < scans.size(); ++i) {
    EXPECT_EQ(scans[i].stamp.ns % 1000000, 0);
    if (i > 0) {
      EXPECT_LT(scans[i - 1].stamp, scans[i].stamp);
    }
  }
}

TEST(Phones, ReportWholeDecibels) {
  for (const auto& scan : simulate_scans(standing, 0, 50, radio_heard_with(-40.4), 0, plain(), Rng(1)))
    EXPECT_EQ(scan.readings.at(0).rssi_dbm, -40);
}

TEST(Phones, DetectWeakTransmittersNowAndThen) {
  const PhoneParams params = plain();
  const auto heard = [&](double power_dbm) {
    return static_cast<double>(
               simulate_scans(standing, 0, 2000, radio_heard_with(power_dbm), 0, params, Rng(1)).size()) /
           5000;
  };
  EXPECT_NEAR(heard(params.threshold_dbm), 0.5, 0.04);
  EXPECT_NEAR(heard(params.threshold_dbm + params.threshold_softness_db), 1 / (1 + std::exp(-1)), 0.04);
  EXPECT_NEAR(heard(params.threshold_dbm - params.threshold_softness_db), 1 / (1 + std::exp(1)), 0.04);
  EXPECT_GT(heard(-60), 0.99);
}

TEST(Phones, NeverReportBelowTheirFloor) {
  PhoneParams params = plain();
  params.threshold_dbm = -200;
  EXPECT_FALSE(simulate_scans(standing, 0, 50, radio_heard_with(-97.4), 0, params, Rng(1)).empty());
  EXPECT_TRUE(simulate_scans(standing, 0, 50, radio_heard_with(-97.6), 0, params, Rng(1)).empty());
}

TEST(Phones, FadeByTheSigmaAskedFor) {
  PhoneParams params = plain();
  params.sigma_fading_db = 3;
  double sum = 0, squares = 0;
  const auto scans = simulate_scans(standing, 0, 4000, radio_heard_with(-50), 0, params, Rng(1));
  for (const auto& scan : scans) {
    const double off = static_cast<double>(scan.readings.at(0).rssi_dbm) + 50;
    sum += off;
    squares += off * off;
  }
  const auto n = static_cast<double>(scans.size());
  EXPECT_NEAR(sum / n, 0, 5 * 3 / std::sqrt(n));
  EXPECT_NEAR(squares / n, 9 + 1.0 / 12, 0.7);  // and the rounding's variance
}

TEST(Phones, DifferByTheirOffsets) {
  PhoneParams params = plain();
  params.phones = 400;
  params.sigma_phone_offset_db = 4;
  double squares = 0;
  const auto scans = simulate_scans(standing, 0, 4.2, radio_heard_with(-50), 0, params, Rng(1));
  for (const auto& scan : scans)
    squares += std::pow(static_cast<double>(scan.readings.at(0).rssi_dbm) + 50, 2);
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(scans.size())), 4, 0.7);
}

}  // namespace
}  // namespace radioslam
