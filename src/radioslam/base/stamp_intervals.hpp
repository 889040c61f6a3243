// Nominal interval of a recording: the median time between successive stamps.
#pragma once

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/base/statistics.hpp"

namespace radioslam {

/// `stamp_of`: stamp of an item, or a member that is it. 0 for fewer than two items.
template <class Items, class StampOf>
double median_interval_s(const Items& items, const StampOf& stamp_of) {
  std::vector<double> intervals_s;
  for (std::size_t k = 1; k < items.size(); ++k)
    intervals_s.push_back(
        seconds_between(std::invoke(stamp_of, items[k - 1]), std::invoke(stamp_of, items[k])));
  return intervals_s.empty() ? 0 : upper_median(std::move(intervals_s));
}

inline double median_interval_s(const std::vector<Stamp>& stamps) {
  return median_interval_s(stamps, std::identity());
}

}  // namespace radioslam
