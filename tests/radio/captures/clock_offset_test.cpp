#include "radioslam/radio/captures/clock_offset.hpp"

#include <gtest/gtest.h>

#include "radio/aoa/simulated_exchange.hpp"

namespace radioslam {
namespace {

using namespace waves;

constexpr double kTwoPi = 2 * std::numbers::pi;

/// A few waves as in a room, so that the channel changes at every position.
PathsBetween few_waves() {
  return plane_wave_paths({{0.3, 0, -15, 3e-8}, {2.1, 0.2, -18, 5e-8}, {-1.5, 0, -20, 6e-8}});
}

/// Motion along a circle that stops every two seconds.
SimulatedExchange stop_and_go_exchange() {
  SimulatedExchange exchange;
  exchange.motion = [](double t_s) {
    return on_circle(0.6, 0.3 * (t_s - std::sin(kTwoPi * t_s / 2) / kTwoPi * 2));
  };
  exchange.paths = few_waves();
  exchange.end_s = 12;
  return exchange;
}

TEST(ClockOffset, OfStopAndGoIsRecovered) {
  for (const double late_s : {0.0, 0.15}) {
    SimulatedExchange exchange = stop_and_go_exchange();
    exchange.cards.stamp_offset_s = late_s;
    const auto clock = estimate_clock_offset(exchange.two_way(), exchange.trajectory()).clock;
    ASSERT_TRUE(clock) << late_s;
    EXPECT_NEAR(clock->offset_s, -late_s, 0.03) << "offset to add to stamps that are late";
    EXPECT_LT(clock->sigma_s, 0.05);
    EXPECT_GT(clock->sigma_s, 0);
  }
}

TEST(ClockOffset, OfAConstantSpeedIsNothing) {
  SimulatedExchange exchange = stop_and_go_exchange();
  exchange.motion = [](double t_s) { return on_circle(0.6, 0.4 * t_s); };
  const auto result = estimate_clock_offset(exchange.two_way(), exchange.trajectory());
  EXPECT_FALSE(result.clock);
  EXPECT_EQ(result.reason, ClockOffsetFailure::kConstantSpeed);
}

/// The antenna passes near a wall, where the channel changes faster, while the speed changes too slowly to
/// distinguish this from an offset.
TEST(ClockOffset, OfASpeedThatChangesSlowlyIsNothing) {
  for (const double toward_rad : {0.0, 1.5, 3.0}) {
    SimulatedExchange exchange = stop_and_go_exchange();
    exchange.motion = [&](double t_s) {
      return on_circle(0.6, toward_rad + 0.3 * (t_s - std::sin(kTwoPi * t_s / 6) / kTwoPi * 6));
    };
    const auto result = estimate_clock_offset(exchange.two_way(), exchange.trajectory());
    EXPECT_FALSE(result.clock) << result.clock->offset_s;
    EXPECT_EQ(result.reason, ClockOffsetFailure::kConstantSpeed);
  }
}

TEST(ClockOffset, WithoutATrajectoryAroundTheCaptureIsNothing) {
  const SimulatedExchange exchange = stop_and_go_exchange();
  for (const auto& trajectory : {exchange.trajectory(100), Trajectory<SE3>()}) {
    const auto result = estimate_clock_offset(exchange.two_way(), trajectory);
    EXPECT_FALSE(result.clock);
    EXPECT_EQ(result.reason, ClockOffsetFailure::kUncovered);
  }
}

TEST(ClockOffset, OfAntennasAgainstEachOtherIsNothing) {
  ChannelTrack track = stop_and_go_exchange().two_way();
  track.is_two_way = false;
  const auto result = estimate_clock_offset(track, stop_and_go_exchange().trajectory());
  EXPECT_FALSE(result.clock);
  EXPECT_EQ(result.reason, ClockOffsetFailure::kNotTwoWay);
}

TEST(ClockOffset, ShiftingMovesStampsAlone) {
  const ChannelTrack track = stop_and_go_exchange().two_way();
  const ChannelTrack moved = shifted(track, -0.25);
  ASSERT_EQ(moved.stamps.size(), track.stamps.size());
  for (std::size_t k = 0; k < track.stamps.size(); ++k)
    EXPECT_EQ(moved.stamps[k].ns, track.stamps[k].ns - 250'000'000);
  EXPECT_EQ(moved.channel, track.channel);
}

}  // namespace
}  // namespace radioslam
