#include <gtest/gtest.h>

#include "radio/aoa/waves.hpp"
#include "radioslam/radio/aoa/delay_alignment.hpp"
#include "radioslam/radio/channel/two_way_channel.hpp"

namespace radioslam {
namespace {

using namespace waves;

constexpr double kNanosecond_s = 1e-9;

Eigen::RowVectorXcd delayed(double delay_s) {
  const auto hz = subcarriers();
  Eigen::RowVectorXcd row(std::ssize(hz));
  for (Eigen::Index s = 0; s < row.size(); ++s)
    row[s] = std::polar(2.0, -2 * std::numbers::pi * hz[static_cast<std::size_t>(s)] * delay_s);
  return row;
}

TEST(DelayTable, FindsADelayBetweenItsColumns) {
  const DelayTable delays = packet_delays(subcarriers());
  for (double delay_s = -250 * kNanosecond_s; delay_s < 250 * kNanosecond_s; delay_s += 3.7 * kNanosecond_s)
    EXPECT_NEAR(delays.best_delay_s(delayed(delay_s)), delay_s, 0.1 * kNanosecond_s)
        << "columns are 7.1 ns apart";
}

TEST(DelayTable, ReachesAsFarAsItSaysAndNoFurther) {
  const DelayTable delays(subcarriers(), 50 * kNanosecond_s, 10 * kNanosecond_s);
  ASSERT_EQ(delays.turns().cols(), 11);
  EXPECT_NEAR(delays.delay_s(0), -50 * kNanosecond_s, 1e-15);
  EXPECT_NEAR(delays.delay_s(10), 50 * kNanosecond_s, 1e-15);
  EXPECT_NEAR(delays.best_delay_s(delayed(58 * kNanosecond_s)), 50 * kNanosecond_s, 1e-15);
}

TEST(SubcarrierSlopes, DelaysAddUpAndTakeEachOtherOff) {
  const auto hz = subcarriers();
  Eigen::RowVectorXcd row = delayed(0);
  advance(row, hz, 30 * kNanosecond_s);
  EXPECT_LT((row - delayed(-30 * kNanosecond_s)).norm(), 1e-9) << "advanced: earlier";
  advance(row, hz, 20 * kNanosecond_s);
  advance(row, hz, -50 * kNanosecond_s);
  EXPECT_LT((row - delayed(0)).norm(), 1e-9);
}

/// Channel of two waves along a path, and the same as measured by a card with random detection delays.
struct Measured {
  std::vector<double> subcarrier_hz = subcarriers();
  Eigen::MatrixXcd air, card;

  Measured() {
    Rng rng(4);
    air = array_of({{{1, 0, 0}, 0, 1}, {{2.6, 0, 0}, 40 * kNanosecond_s, 0.6}}, arc(200, 0.5, 1)).channel;
    card = air;
    for (Eigen::Index k = 0; k < card.rows(); ++k) {
      Eigen::RowVectorXcd row = card.row(k);
      advance(row, subcarrier_hz, rng.uniform(-80, 80) * kNanosecond_s);
      card.row(k) = row;
    }
  }
};

/// Delay of each row relative to the true channel.
std::vector<double> delays_left(const Measured& measured, const Eigen::MatrixXcd& channel) {
  const DelayTable table = packet_delays(measured.subcarrier_hz);
  std::vector<double> left;
  for (Eigen::Index k = 0; k < channel.rows(); ++k)
    left.push_back(table.best_delay_s(channel.row(k).cwiseProduct(measured.air.row(k).conjugate())));
  return left;
}

double spread(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end()) - *std::min_element(values.begin(), values.end());
}

TEST(SubcarrierSlopes, ComeOffAgainstTheTrueChannel) {
  Measured measured;
  EXPECT_GT(spread(delays_left(measured, measured.card)), 100 * kNanosecond_s) << "or the test shows nothing";
  align_to_model(measured.card, measured.subcarrier_hz, packet_delays(measured.subcarrier_hz), measured.air);
  for (const double left_s : delays_left(measured, measured.card))
    EXPECT_NEAR(left_s, 0, 0.3 * kNanosecond_s);
  EXPECT_LT((measured.card - measured.air).norm(), 0.02 * measured.air.norm());
}

TEST(SubcarrierSlopes, ComeOffAgainstThePredecessorsButForOneDelayAndTheChannelsOwn) {
  Measured measured;
  align_to_predecessors(measured.card, measured.subcarrier_hz, packet_delays(measured.subcarrier_hz), 0.15);
  const auto left = delays_left(measured, measured.card);
  double roughest_s = 0;
  for (std::size_t k = 1; k < left.size(); ++k)
    roughest_s = std::max(roughest_s, std::abs(left[k] - left[k - 1]));
  EXPECT_LT(roughest_s, 5 * kNanosecond_s) << "the residual changes slowly";
  EXPECT_LT(spread(left), 50 * kNanosecond_s) << "the mean delay of the two waves remains";
}

TEST(SubcarrierSlopes, KeepRowsOfZeros) {
  Eigen::MatrixXcd channel = Eigen::MatrixXcd::Zero(3, 30);
  channel.row(2) = delayed(20 * kNanosecond_s);
  align_to_predecessors(channel, subcarriers(), packet_delays(subcarriers()), 0.15);
  EXPECT_EQ(channel.topRows(2).norm(), 0);
  EXPECT_LT((channel.row(2) - delayed(0)).norm(), 0.05);
}

}  // namespace
}  // namespace radioslam
