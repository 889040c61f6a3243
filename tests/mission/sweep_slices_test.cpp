#include "radioslam/mission/sweep_slices.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace radioslam {
namespace {

constexpr std::int64_t kSweep_ns = 100'000'000;
constexpr int kPointsPerSweep = 360;

/// Slices of sweeps of one point per degree at 10 m, 0.1 s each, that turn to the left or to the right.
std::vector<StampedScan> slices_of(int sweeps, int per_sweep, bool is_clockwise = true) {
  std::vector<StampedScan> slices;
  const int size = kPointsPerSweep / per_sweep;
  for (int k = 0; k < sweeps * per_sweep; ++k) {
    StampedScan& slice = slices.emplace_back();
    slice.stamp = {kSweep_ns * k / per_sweep};
    for (int p = 0; p < size; ++p) {
      const double turned = (0.5 + k * size + p) * std::numbers::pi / 180;
      const auto angle = static_cast<float>(is_clockwise ? -turned : turned);
      slice.scan.points.emplace_back(10 * std::cos(angle), 10 * std::sin(angle), 1);
    }
  }
  return slices;
}

/// The sweeps of all slices, without the pieces at the ends.
std::vector<StampedScan> gathered(const std::vector<StampedScan>& slices, SweepAssembler& assembler) {
  std::vector<StampedScan> sweeps;
  for (const StampedScan& slice : slices)
    for (StampedScan& sweep : assembler.add(slice)) sweeps.push_back(std::move(sweep));
  for (StampedScan& sweep : assembler.finish()) sweeps.push_back(std::move(sweep));
  return sweeps;
}

std::vector<StampedScan> gathered(const std::vector<StampedScan>& slices) {
  const auto motion = motion_of_slices({slices.data(), 10});
  if (!motion) return {};
  SweepAssembler assembler(*motion);
  return gathered(slices, assembler);
}

TEST(SweepSlices, AreGatheredForAnyNumberAndDirection) {
  for (const int per_sweep : {2, 3, 4, 6, 8, 10, 72, 360})
    for (const bool is_clockwise : {false, true}) {
      const auto sweeps = gathered(slices_of(12, per_sweep, is_clockwise));
      ASSERT_EQ(sweeps.size(), 12U) << per_sweep << is_clockwise;
      for (std::size_t k = 0; k < sweeps.size(); ++k) {
        EXPECT_EQ(sweeps[k].scan.points.size(), 360U) << per_sweep << is_clockwise;
        EXPECT_EQ(sweeps[k].stamp.ns, static_cast<std::int64_t>(k) * kSweep_ns);
      }
    }
}

TEST(SweepSlices, KeepTheTimesOfTheirPoints) {
  auto slices = slices_of(4, 8);
  const auto untimed = gathered(slices);
  EXPECT_EQ(untimed.at(1).scan.times_s.at(0), 0);
  EXPECT_FLOAT_EQ(untimed.at(1).scan.times_s.at(100), 0.025F) << "the third slice's stamp";
  for (StampedScan& slice : slices) slice.scan.times_s.assign(slice.scan.points.size(), 0.001F);
  EXPECT_FLOAT_EQ(gathered(slices).at(1).scan.times_s.at(100), 0.026F);
}

TEST(SweepSlices, OfOneStampPerSweepAreGathered) {
  auto slices = slices_of(6, 8);
  for (StampedScan& slice : slices) slice.stamp.ns -= slice.stamp.ns % kSweep_ns;
  const auto sweeps = gathered(slices);
  ASSERT_EQ(sweeps.size(), 6U);
  EXPECT_EQ(sweeps[2].scan.points.size(), 360U);
  EXPECT_TRUE(sweeps[2].scan.times_s.empty()) << "no time is known within the sweep";
}

TEST(SweepSlices, ThatAreMissingRepeatedOrLateSpoilNoOtherSweep) {
  auto slices = slices_of(12, 8);
  std::swap(slices[41], slices[42]);
  slices.insert(slices.begin() + 30, slices[29]);
  slices.erase(slices.begin() + 20);
  const auto motion = motion_of_slices({slices.data(), 10});
  ASSERT_TRUE(motion);
  SweepAssembler assembler(*motion);
  const auto sweeps = gathered(slices, assembler);
  ASSERT_EQ(sweeps.size(), 12U);
  for (std::size_t k = 0; k < sweeps.size(); ++k)
    EXPECT_EQ(sweeps[k].scan.points.size(), k == 2 ? 315U : 360U) << k;
  EXPECT_EQ(assembler.counts().repeated, 1U);
  EXPECT_EQ(assembler.counts().missing, 1U);
  SweepAssembler other(*motion);
  auto late = slices_of(12, 8);
  late.push_back(late.front());
  EXPECT_EQ(gathered(late, other).size(), 12U);
  EXPECT_EQ(other.counts().late, 1U);
}

TEST(SweepSlices, OnBothSidesOfAGapAreNotJoined) {
  auto slices = slices_of(12, 8);
  slices.erase(slices.begin() + 43, slices.begin() + 62);
  const auto sweeps = gathered(slices);
  ASSERT_EQ(sweeps.size(), 11U);
  EXPECT_EQ(sweeps[5].scan.points.size(), 3 * 45U);
  EXPECT_EQ(sweeps[6].scan.points.size(), 2 * 45U);
}

TEST(SweepSlices, AreNotSeenInWholeSweepsAndFixedSectors) {
  EXPECT_FALSE(motion_of_slices(slices_of(12, 1)));
  auto sectors = slices_of(12, 1);  // a scanner that sees 70 degrees
  for (StampedScan& sector : sectors) sector.scan.points.resize(70);
  EXPECT_FALSE(motion_of_slices(sectors));
  for (StampedScan& sector : sectors) sector.scan.points.clear();
  EXPECT_FALSE(motion_of_slices(sectors)) << "no points";
  EXPECT_FALSE(motion_of_slices({slices_of(1, 8).data(), 5})) << "too few";
  auto slow = slices_of(2, 8);  // one wall, and a robot that turns
  for (StampedScan& slice : slow) slice.stamp.ns *= 30;
  EXPECT_FALSE(motion_of_slices(slow));
}

}  // namespace
}  // namespace radioslam
