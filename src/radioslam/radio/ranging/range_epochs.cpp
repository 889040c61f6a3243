#include "radioslam/radio/ranging/range_epochs.hpp"

#include <algorithm>

#include "radioslam/base/statistics.hpp"

namespace radioslam {
namespace {

void set_mean_stamp(RangeEpoch& epoch) {
  const Stamp first = epoch.ranges.front().stamp;
  std::int64_t later_ns = 0;
  for (const auto& range : epoch.ranges) later_ns += range.stamp.ns - first.ns;
  epoch.stamp.ns = first.ns + later_ns / static_cast<std::int64_t>(epoch.ranges.size());
}

bool continues(const RangeEpoch& epoch, const AnchorRange& next, double epoch_s) {
  if (seconds_between(epoch.ranges.front().stamp, next.stamp) > epoch_s) return false;
  return std::none_of(epoch.ranges.begin(), epoch.ranges.end(),
                      [&](const AnchorRange& range) { return range.pair == next.pair; });
}

/// Median per axis over the fixes [begin, end).
Eigen::Vector3d median_position(const std::vector<PositionFix>& fixes, std::size_t begin, std::size_t end) {
  Eigen::Vector3d result;
  std::vector<double> values(end - begin);
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t k = begin; k < end; ++k) values[k - begin] = fixes[k].position_m[axis];
    result[axis] = median(values);
  }
  return result;
}

/// Half-width of the window around k: up to `most` neighbours on either side, without gaps.
std::size_t reach_at(const std::vector<PositionFix>& fixes, std::size_t k, std::size_t most,
                     double max_gap_s) {
  const auto joined = [&](std::size_t a) {
    return seconds_between(fixes[a].stamp, fixes[a + 1].stamp) <= max_gap_s;
  };
  std::size_t reach = 0;
  while (reach < most && k > reach && k + reach + 1 < fixes.size() && joined(k - reach - 1) &&
         joined(k + reach))
    ++reach;
  return reach;
}

}  // namespace

std::vector<RangeEpoch> range_epochs(const std::vector<AnchorRange>& ranges, const RangeEpochParams& params) {
  std::vector<RangeEpoch> epochs;
  for (const auto& range : ranges) {
    if (epochs.empty() || !continues(epochs.back(), range, params.epoch_s)) epochs.emplace_back();
    epochs.back().ranges.push_back(range);
  }
  for (auto& epoch : epochs) set_mean_stamp(epoch);
  return epochs;
}

std::vector<PositionFix> moving_median(const std::vector<PositionFix>& fixes,
                                       const RangeEpochParams& params) {
  std::vector<PositionFix> smooth = fixes;
  const auto half = static_cast<std::size_t>(params.median_samples / 2);
  const bool is_even = params.median_samples % 2 == 0;
  for (std::size_t k = 0; k < fixes.size(); ++k) {
    const std::size_t reach = reach_at(fixes, k, half, params.max_gap_s);
    if (is_even && reach == half)
      smooth[k].position_m = 0.5 * (median_position(fixes, k - reach, k + reach) +
                                    median_position(fixes, k - reach + 1, k + reach + 1));
    else
      smooth[k].position_m = median_position(fixes, k - reach, k + reach + 1);
  }
  return smooth;
}

}  // namespace radioslam
