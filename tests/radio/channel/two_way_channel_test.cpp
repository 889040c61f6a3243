#include "radioslam/radio/channel/two_way_channel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "io/recorded_data.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/io/csi/intel5300.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {
namespace {

constexpr MacAddress kSender{0x00216a3f175a};
constexpr double kRate_hz = 120;

double path_phase(int k) { return 0.8 * std::sin(0.01 * k) + 0.002 * k; }  // one-way

struct Exchanged {
  CsiCapture receiver, answers;
};

struct World {
  int exchanges = 600;
  double rate_hz = kRate_hz;
  double offset_hz = -9300;
  double clock_rate = 2e-5;  ///< drift of the sender's clock relative to the receiver's
  int later_us = 0;          ///< added delay of two thirds of the replies in the second half
  int earlier_us = 0;        ///< advance of every fiftieth reply
  double noise = 0.1;
};

CsiPacket packet(double t_s, double clock_us, int counter, std::complex<double> channel) {
  CsiPacket result;
  result.stamp = {static_cast<std::int64_t>(t_s * 1e9)};
  result.clock_us = static_cast<std::uint32_t>(static_cast<std::int64_t>(clock_us));
  result.sender = kSender;
  result.counter = static_cast<std::uint32_t>(counter);
  result.antennas = result.streams = 1;
  result.channel.setConstant(1, 6, std::complex<float>(50.0 * channel));
  return result;
}

/// Packets and replies of cards whose carriers differ; every reply has its own delay.
Exchanged exchange(const World& world) {
  Rng rng(3);
  Exchanged result;
  for (const double hz : {-3e5, -2e5, -1e5, 1e5, 2e5, 3e5}) {
    result.receiver.subcarrier_hz.push_back(hz);
    result.answers.subcarrier_hz.push_back(hz);
  }
  for (int k = 0; k < world.exchanges; ++k) {
    const bool is_later = 2 * k > world.exchanges && k % 3 != 0, is_earlier = k % 50 == 0;
    const double wait_us = 300 - 8 * std::log(1 - rng.uniform(0, 1)) + (is_later ? world.later_us : 0) -
                           (is_earlier ? world.earlier_us : 0);
    const double t_s = k / world.rate_hz;
    const double oscillators = rng.uniform(-std::numbers::pi, std::numbers::pi);
    const double rejected = 2 * std::numbers::pi * world.offset_hz * wait_us * 1e-6;
    const auto noise = [&] {
      return std::complex<double>(rng.normal(0, world.noise), rng.normal(0, world.noise));
    };
    result.answers.packets.push_back(packet(t_s, 4.29e9 + t_s * 1e6 * (1 + world.clock_rate), k,
                                            std::polar(1.0, path_phase(k) + oscillators) + noise()));
    result.receiver.packets.push_back(
        packet(t_s + 0.001, 5e5 + t_s * 1e6 + wait_us, k,
               std::polar(1.0, path_phase(k) - oscillators + rejected) + noise()));
  }
  return result;
}

/// Circular standard deviation of the products' phases from twice the path's.
double phase_error_rad(const TwoWayChannel& channel) {
  std::complex<double> sum = 0;
  for (std::size_t row = 0; row < channel.stamps.size(); ++row) {
    const int k = static_cast<int>(
        std::lround((static_cast<double>(channel.stamps[row].ns) * 1e-9 - 0.001) * kRate_hz));
    const std::complex<double> p = channel.product(static_cast<Eigen::Index>(row), 2);
    sum += p / std::abs(p) * std::polar(1.0, -2 * path_phase(k));
  }
  return std::sqrt(-2 * std::log(std::abs(sum) / static_cast<double>(channel.stamps.size())));
}

TEST(TwoWayChannel, UndoesTheJitterOfTheAnswers) {
  for (const int apart_us : {0, 130}) {
    World world;
    world.later_us = world.earlier_us = apart_us;
    const auto [receiver, answers] = exchange(world);
    const auto channel = two_way_channel(receiver, kSender, answers, {}).channel;
    ASSERT_TRUE(channel);
    EXPECT_EQ(channel->paired, 600U);
    EXPECT_GT(channel->stamps.size(), 580U);
    EXPECT_NEAR(channel->frequency_offset_hz, world.offset_hz, 500);
    EXPECT_GT(*channel->coherence, 0.95);
    EXPECT_LT(channel->coherence_before, 0.92);
    EXPECT_LT(phase_error_rad(*channel), 0.3) << apart_us;
    TwoWayParams blind;
    blind.max_offset_hz = 100;
    EXPECT_GT(phase_error_rad(*two_way_channel(receiver, kSender, answers, blind).channel), 0.4)
        << "or the test shows nothing";
  }
}

TEST(TwoWayChannel, CancelsWhatTheOscillatorsAdd) {
  World world;
  world.offset_hz = 0;
  world.noise = 0;
  const auto [receiver, answers] = exchange(world);
  const auto channel = two_way_channel(receiver, kSender, answers, {}).channel;
  ASSERT_TRUE(channel);
  EXPECT_LT(phase_error_rad(*channel), 0.03);
  EXPECT_NEAR(std::abs(channel->product(5, 0)), 2500, 0.01);
}

TEST(TwoWayChannel, PairsByCounterAndSender) {
  auto [receiver, answers] = exchange({});
  receiver.packets[10].sender = MacAddress{1};          // another sender
  receiver.packets[20].counter = 21;                    // duplicate counter
  answers.packets.erase(answers.packets.begin() + 30);  // lost
  const auto channel = two_way_channel(receiver, kSender, answers, {}).channel;
  ASSERT_TRUE(channel);
  EXPECT_EQ(channel->paired, 600U - 4U);
  for (std::size_t k = 1; k < channel->stamps.size(); ++k)
    EXPECT_LT(channel->stamps[k - 1], channel->stamps[k]);
}

TEST(TwoWayChannel, IsNothingWithoutExchanges) {
  auto [receiver, answers] = exchange({});
  EXPECT_FALSE(two_way_channel(receiver, MacAddress{1}, answers, {}).channel);
  for (CsiPacket& packet : answers.packets) packet.counter.reset();
  EXPECT_FALSE(two_way_channel(receiver, kSender, answers, {}).channel);
}

TEST(TwoWayChannel, ReportsOtherSubcarriers) {
  auto [receiver, answers] = exchange({});
  answers.subcarrier_hz.back() += 312.5e3;
  EXPECT_EQ(two_way_channel(receiver, kSender, answers, {}).reason, TwoWayFailure::kOtherSubcarriers);
}

// At any rate the offset is found, and the replies of another robot are rejected.
TEST(TwoWayChannel, DistinguishesRightFromWrongRepliesAtAnyRate) {
  for (const double rate_hz : {400.0, 40.0, 5.0}) {
    World world;
    world.rate_hz = rate_hz;
    auto [receiver, answers] = exchange(world);
    const auto right = two_way_channel(receiver, kSender, answers, {}).channel;
    ASSERT_TRUE(right) << rate_hz;
    EXPECT_NEAR(right->frequency_offset_hz, world.offset_hz, 500) << rate_hz;
    EXPECT_GT(*right->coherence, 0.9) << rate_hz;
    Rng rng(5);
    for (CsiPacket& packet : answers.packets)
      packet.channel *= std::polar(1.0F, static_cast<float>(rng.uniform(0, 6.3)));
    const auto wrong = two_way_channel(receiver, kSender, answers, {});
    EXPECT_FALSE(wrong.channel) << rate_hz;
    EXPECT_EQ(wrong.reason, TwoWayFailure::kIncoherent) << rate_hz;
  }
}

TEST(TwoWayChannel, HasNoCoherenceForFewExchanges) {
  World world;
  world.exchanges = 60;
  const auto [receiver, answers] = exchange(world);
  const auto channel = two_way_channel(receiver, kSender, answers, {}).channel;
  ASSERT_TRUE(channel);
  EXPECT_FALSE(channel->coherence);
}

TEST(TwoWayChannel, OfRecordedExchangesIsCoherent) {
  RADIOSLAM_RECORDED(folder, "wsr/raw/LOS_Set_A/0627_2D-multi-link_A_L1");
  const auto capture = [&](const char* file) { return read_intel5300(file, read_bytes(folder / file)); };
  const auto channel = two_way_channel(capture("csi_rx_2021-06-27_202550.dat"), MacAddress{0x00216ab26efa},
                                       capture("csi_tx4_2021-06-27_202550.dat"), {})
                           .channel;
  ASSERT_TRUE(channel);
  EXPECT_LT(channel->coherence_before, 0.7);
  EXPECT_GT(*channel->coherence, 0.9);
}

}  // namespace
}  // namespace radioslam
