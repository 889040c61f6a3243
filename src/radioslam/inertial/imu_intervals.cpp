#include "radioslam/inertial/imu_intervals.hpp"

#include <algorithm>

#include "radioslam/base/check.hpp"

namespace radioslam {
namespace {

using SampleIterator = std::vector<ImuSample>::const_iterator;

/// The first sample after `stamp`.
SampleIterator first_after(const std::vector<ImuSample>& samples, Stamp stamp) {
  return std::upper_bound(samples.begin(), samples.end(), stamp,
                          [](Stamp s, const ImuSample& sample) { return s < sample.stamp; });
}

/// The interpolated sample at `stamp`; nothing if its neighbours are too far apart.
std::optional<ImuSample> sample_at(const std::vector<ImuSample>& samples, Stamp stamp, double max_gap_s) {
  const auto after = first_after(samples, stamp);
  const ImuSample& b = after == samples.end() ? samples.back() : *after;
  const ImuSample& a = after == samples.begin() ? samples.front() : *(after - 1);
  const double gap = seconds_between(std::min(a.stamp, stamp), std::max(b.stamp, stamp));
  if (stamp != a.stamp && gap > max_gap_s) return std::nullopt;
  const double fraction =
      a.stamp < b.stamp ? seconds_between(a.stamp, stamp) / seconds_between(a.stamp, b.stamp) : 0;
  return ImuSample{stamp, a.specific_force_mps2 + fraction * (b.specific_force_mps2 - a.specific_force_mps2),
                   a.angular_rate_radps + fraction * (b.angular_rate_radps - a.angular_rate_radps)};
}

ImuInterval between(const ImuSample& a, const ImuSample& b) {
  return {seconds_between(a.stamp, b.stamp), 0.5 * (a.angular_rate_radps + b.angular_rate_radps),
          0.5 * (a.specific_force_mps2 + b.specific_force_mps2)};
}

}  // namespace

std::optional<std::vector<ImuInterval>> imu_intervals(const std::vector<ImuSample>& samples, Stamp from,
                                                      Stamp to, double max_gap_s) {
  RADIOSLAM_CHECK(from <= to, "the motion runs forward in time");
  if (samples.empty()) return std::nullopt;
  const auto first = sample_at(samples, from, max_gap_s), last = sample_at(samples, to, max_gap_s);
  if (!first || !last) return std::nullopt;
  std::vector<ImuInterval> intervals;
  ImuSample before = *first;
  for (auto next = first_after(samples, from); next != samples.end() && next->stamp < to; ++next) {
    if (seconds_between(before.stamp, next->stamp) > max_gap_s) return std::nullopt;
    intervals.push_back(between(before, *next));
    before = *next;
  }
  if (seconds_between(before.stamp, to) > max_gap_s) return std::nullopt;
  if (before.stamp < to) intervals.push_back(between(before, *last));
  return intervals;
}

}  // namespace radioslam
