#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "radioslam/base/random.hpp"
#include "radioslam/radio/channel/capture_power.hpp"

namespace radioslam {
namespace {

constexpr std::array kModulations{Modulation::kBpsk, Modulation::kQpsk, Modulation::kQam16,
                                  Modulation::kQam64};
constexpr double kNoSignal_db = -std::numeric_limits<double>::infinity();

using PerModulation = std::array<double, 4>;

std::vector<double> random_channel(Rng& rng, double min_db, double max_db) {
  std::vector<double> snr_db;
  for (int k = 0; k < 30; ++k) snr_db.push_back(rng.uniform(min_db, max_db));
  return snr_db;
}

TEST(EffectiveSnr, OfAFlatChannelIsItsSnr) {
  for (const Modulation modulation : kModulations)
    for (const double snr_db : {-50.0, -20.0, 0.0, 7.5, 30.0, 80.0})
      EXPECT_NEAR(effective_snr_db(std::vector<double>(30, snr_db), modulation), snr_db, 1e-6);
}

/// By hand, from tables of Q: QPSK at 0 dB has the error rate Q(1) = 0.158655, and half of it together with
/// an error-free subcarrier: Q(x) = 0.0793276 at x = 1.40951, which is 20 log10 x = 2.9814 dB.
TEST(EffectiveSnr, OfHalfAFadedChannelByHand) {
  EXPECT_NEAR(effective_snr_db(std::vector{0.0, 60.0}, Modulation::kQpsk), 2.9814, 1e-3);
}

/// The values below are bisections of the same definition in 60 decimal digits (mpmath).
TEST(EffectiveSnr, AgreesWithManyDigits) {
  struct Case {
    std::vector<double> snr_db;
    PerModulation expected_db;
  };
  std::vector<double> one_deep_fade(30, 30.0);
  one_deep_fade.back() = -10;
  const std::array cases{
      Case{{20, 20, 20, 5}, {6.44515004242227, 7.41652059068607, 11.1454788527614, 15.4482309801444}},
      Case{{-50, 0, 10, 25, 80}, {-1.43801082333698, 0.974228894074351, 6.18218541645746, 10.5274825479382}},
      Case{{60, 70, 80}, {60.0000047712075, 60.0000095424051, 60.0000477116248, 60.0002003820963}},
      Case{{-50, -45, -40}, {-44.0659545199655, -44.065918082765, -44.0658889328607, -44.0658833804835}},
      Case{one_deep_fade, {4.19935931585171, 7.00674909418724, 13.7413137947902, 19.8738104270555}}};
  for (const Case& c : cases)
    for (std::size_t m = 0; m < kModulations.size(); ++m)
      EXPECT_NEAR(effective_snr_db(c.snr_db, kModulations[m]), c.expected_db[m], 1e-9);
}

TEST(EffectiveSnr, LogarithmsOfErrorRatesAgreeWithManyDigits) {
  struct Case {
    double snr_db;
    PerModulation expected;
  };
  for (const Case& c :
       {Case{-50, {-0.69672179823801669, -0.69567349732938172, -0.98195826890134759, -1.2326944255364485}},
        Case{10, {-12.46171144071682, -7.1527596347100671, -2.8304347629449745, -1.9451814537692482}},
        Case{40, {-10005.870732303224, -5005.5242086942051, -1005.0075712119637, -242.63817118383711}},
        Case{80, {-100000010.4758525, -50000010.129278915, -10000009.612242071, -2380961.526966778}}})
    for (std::size_t m = 0; m < kModulations.size(); ++m)
      EXPECT_NEAR(log_bit_error_rate(c.snr_db, kModulations[m]), c.expected[m],
                  1e-12 * std::abs(c.expected[m]));
}

TEST(EffectiveSnr, LiesBetweenTheLeastAndTheMeanAndGrowsWithTheBitsOfASymbol) {
  Rng rng(5);
  for (int trial = 0; trial < 200; ++trial) {
    const auto snr_db = random_channel(rng, -50, 80);
    double mean = 0;
    for (const double snr : snr_db) mean += std::pow(10, snr / 10) / 30;
    double last_db = *std::min_element(snr_db.begin(), snr_db.end());
    for (const Modulation modulation : kModulations) {
      const double effective_db = effective_snr_db(snr_db, modulation);
      EXPECT_GE(effective_db, last_db - 1e-9);
      last_db = effective_db;
    }
    EXPECT_LE(last_db, 10 * std::log10(mean) + 1e-9);
  }
}

TEST(EffectiveSnr, GrowsWithEverySubcarrier) {
  Rng rng(6);
  for (int trial = 0; trial < 50; ++trial)
    for (const Modulation modulation : kModulations) {
      auto snr_db = random_channel(rng, -10, 20);
      const double before_db = effective_snr_db(snr_db, modulation);
      snr_db[rng.below(snr_db.size())] += 1;
      EXPECT_GE(effective_snr_db(snr_db, modulation), before_db);
    }
  for (const Modulation modulation : kModulations)
    EXPECT_GT(effective_snr_db(std::vector{1.0, 3.0, 5.0}, modulation),
              effective_snr_db(std::vector{1.0, 2.9, 5.0}, modulation));
}

TEST(EffectiveSnr, StaysFiniteWhereAnySubcarrierHasSignal) {
  for (const Modulation modulation : kModulations) {
    for (const auto& snr_db : {std::vector{-50.0, 80.0}, std::vector{kNoSignal_db, 80.0}, std::vector{-50.0},
                               std::vector{80.0, 80.0}})
      EXPECT_TRUE(std::isfinite(effective_snr_db(snr_db, modulation)));
    EXPECT_EQ(effective_snr_db(std::vector{kNoSignal_db, kNoSignal_db}, modulation), kNoSignal_db);
  }
}

}  // namespace
}  // namespace radioslam
