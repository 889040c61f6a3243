#include "radioslam/radio/ranging/range_epochs.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

AnchorRange range_at(double t_s, std::size_t pair) { return {Stamp::from_seconds(t_s), pair, {pair, 1, 1}}; }

TEST(RangeEpochs, EndAfterTheirTimeOrWhereAPairComesAgain) {
  const auto epochs = range_epochs({range_at(0, 0), range_at(0.05, 1), range_at(0.1, 2),  // one cycle
                                    range_at(0.12, 0), range_at(0.2, 1),                  // next cycle
                                    range_at(0.4, 2)});                                   // late
  ASSERT_EQ(epochs.size(), 3U);
  EXPECT_EQ(epochs[0].ranges.size(), 3U);
  EXPECT_EQ(epochs[0].stamp, Stamp::from_seconds(0.05));
  EXPECT_EQ(epochs[1].ranges.size(), 2U);
  EXPECT_EQ(epochs[2].ranges.size(), 1U);
}

PositionFix fix_at(double t_s, double x) { return {Stamp::from_seconds(t_s), {x, 2 * x, 0}, 0.1}; }

TEST(MovingMedian, RemovesSpikesAndDoesNotDelaySteadyMotion) {
  std::vector<PositionFix> fixes;
  for (int k = 0; k < 40; ++k) fixes.push_back(fix_at(0.1 * k, k == 17 || k == 25 ? 500 : 0.3 * k));
  for (const int samples : {10, 9}) {
    RangeEpochParams params;
    params.median_samples = samples;
    const auto smooth = moving_median(fixes, params);
    ASSERT_EQ(smooth.size(), fixes.size());
    for (std::size_t k = 0; k < 40; ++k) {
      const bool near_spike = k > 11 && k < 32;  // the median is then up to one sample off
      EXPECT_NEAR(smooth[k].position_m.x(), 0.3 * static_cast<double>(k), near_spike ? 0.31 : 1e-12) << k;
      EXPECT_NEAR(smooth[k].position_m.y(), 0.6 * static_cast<double>(k), near_spike ? 0.61 : 1e-12) << k;
    }
  }
}

TEST(MovingMedian, DoesNotReachAcrossGaps) {
  std::vector<PositionFix> fixes;
  for (int k = 0; k < 20; ++k) fixes.push_back(fix_at(k < 10 ? 0.1 * k : 100 + 0.1 * k, k < 10 ? 0 : 50));
  for (const auto& fix : moving_median(fixes))
    EXPECT_TRUE(fix.position_m.x() == 0 || fix.position_m.x() == 50);
  EXPECT_TRUE(moving_median({}).empty());
}

}  // namespace
}  // namespace radioslam
