#include <gtest/gtest.h>

#include "mission/phone_walks.hpp"
#include "radioslam/mission/dead_reckoning.hpp"

namespace radioslam {
namespace {

using test::kPi;

constexpr double kRate_hz = 1.8;

std::vector<LevelSample> moving(const std::function<double(double)>& vertical_mps2, double duration_s = 30) {
  std::vector<LevelSample> motion;
  for (int i = 0; i * 0.02 <= duration_s; ++i)
    motion.push_back({test::walk_stamp(0.02 * i), 0, vertical_mps2(0.02 * i)});
  return motion;
}

/// Gain of the band-pass filter (difference of two Gaussian averages) for a sine.
double passed(double rate_hz, const StepParams& params) {
  const auto average = [rate_hz](double sigma_s) {
    return std::exp(-0.5 * std::pow(2 * kPi * rate_hz * sigma_s, 2));
  };
  return average(params.smooth_s) - average(params.detrend_s);
}

TEST(FindSteps, CountsEveryStepOnceAtItsPeak) {
  const auto steps = find_steps(moving(test::steps_between(5, 25, kRate_hz, 3)), {});
  ASSERT_EQ(steps.size(), 36U);  // 20 s
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double peak_s = 5 + (static_cast<double>(i) + 0.5) / kRate_hz;
    EXPECT_NEAR(seconds_between(test::walk_stamp(peak_s), steps[i].end), 0, 0.02);
  }
}

TEST(FindSteps, LengthIsWeinbergs) {
  for (const double amplitude : {1.5, 3.0, 6.0}) {
    const StepParams params;
    const auto steps = find_steps(moving(test::steps_between(0, 30, kRate_hz, amplitude)), params);
    ASSERT_GT(steps.size(), 50U);
    const double expected = params.weinberg_k * std::pow(2 * amplitude * passed(kRate_hz, params), 0.25);
    for (std::size_t i = 5; i + 5 < steps.size(); ++i) EXPECT_NEAR(steps[i].length_m, expected, 0.01);
  }
}

TEST(FindSteps, JitterOfTheHeelStrikeIsNoStep) {
  const auto walking = test::steps_between(0, 30, kRate_hz, 3);
  const auto jittering = [&](double t) { return walking(t) + 2 * std::sin(2 * kPi * 9 * t); };
  EXPECT_EQ(find_steps(moving(jittering), {}).size(), find_steps(moving(walking), {}).size());
}

TEST(FindSteps, AStillHandDoesNotWalk) {
  Rng rng(1);
  EXPECT_TRUE(find_steps(moving([&](double) { return rng.normal(0, 0.5); }), {}).empty());
  EXPECT_TRUE(find_steps({}, {}).empty());
}

TEST(FindSteps, AfterAPauseAFirstStepHasNominalDuration) {
  const auto before = test::steps_between(2, 10, kRate_hz, 3);
  const auto after = test::steps_between(15, 20, kRate_hz, 3);
  const StepParams params;
  const auto steps = find_steps(moving([&](double t) { return before(t) + after(t); }), params);
  std::size_t first_steps = 0;
  for (std::size_t i = 1; i < steps.size(); ++i) {
    EXPECT_LE(steps[i - 1].end, steps[i].begin);
    if (steps[i].begin == steps[i - 1].end) continue;
    ++first_steps;
    EXPECT_NEAR(seconds_between(steps[i].begin, steps[i].end), params.nominal_step_s, 1e-9);
  }
  EXPECT_EQ(first_steps, 1U);
}

TEST(FindSteps, SlowAndFastWalkingAreBothCounted) {
  for (const double rate_hz : {1.3, 1.8, 2.3})
    EXPECT_NEAR(static_cast<double>(find_steps(moving(test::steps_between(0, 30, rate_hz, 3)), {}).size()),
                30 * rate_hz, 1)
        << rate_hz;
}

}  // namespace
}  // namespace radioslam
