#include "radioslam/inertial/reading_intervals.hpp"

#include <algorithm>

#include "radioslam/base/check.hpp"

namespace radioslam {
namespace {

using SampleIterator = std::vector<InertialSample>::const_iterator;

/// The first reading after `stamp`.
SampleIterator first_after(const std::vector<InertialSample>& samples, Stamp stamp) {
  return std::upper_bound(samples.begin(), samples.end(), stamp,
                          [](Stamp s, const InertialSample& sample) { return s < sample.stamp; });
}

/// The reading at `stamp`; nothing where the neighbours are too far.
std::optional<InertialSample> sample_at(const std::vector<InertialSample>& samples, Stamp stamp,
                                        double longest_gap_s) {
  const auto after = first_after(samples, stamp);
  const InertialSample& b = after == samples.end() ? samples.back() : *after;
  const InertialSample& a = after == samples.begin() ? samples.front() : *(after - 1);
  const double gap = seconds_between(std::min(a.stamp, stamp), std::max(b.stamp, stamp));
  if (stamp != a.stamp && gap > longest_gap_s) return std::nullopt;
  const double share =
      a.stamp < b.stamp ? seconds_between(a.stamp, stamp) / seconds_between(a.stamp, b.stamp) : 0;
  return InertialSample{stamp,
                        a.specific_force_mps2 + share * (b.specific_force_mps2 - a.specific_force_mps2),
                        a.angular_rate_radps + share * (b.angular_rate_radps - a.angular_rate_radps)};
}

ReadingInterval between(const InertialSample& a, const InertialSample& b) {
  return {seconds_between(a.stamp, b.stamp), 0.5 * (a.angular_rate_radps + b.angular_rate_radps),
          0.5 * (a.specific_force_mps2 + b.specific_force_mps2)};
}

}  // namespace

std::optional<std::vector<ReadingInterval>> reading_intervals(const std::vector<InertialSample>& samples,
                                                              Stamp from, Stamp to, double longest_gap_s) {
  RADIOSLAM_CHECK(from <= to, "the motion runs forward in time");
  if (samples.empty()) return std::nullopt;
  const auto first = sample_at(samples, from, longest_gap_s), last = sample_at(samples, to, longest_gap_s);
  if (!first || !last) return std::nullopt;
  std::vector<ReadingInterval> intervals;
  InertialSample before = *first;
  for (auto next = first_after(samples, from); next != samples.end() && next->stamp < to; ++next) {
    if (seconds_between(before.stamp, next->stamp) > longest_gap_s) return std::nullopt;
    intervals.push_back(between(before, *next));
    before = *next;
  }
  if (seconds_between(before.stamp, to) > longest_gap_s) return std::nullopt;
  if (before.stamp < to) intervals.push_back(between(before, *last));
  return intervals;
}

}  // namespace radioslam
