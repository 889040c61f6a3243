#include "radioslam/io/text/skipped_records.hpp"

#include <algorithm>
#include <limits>

#include "radioslam/base/units.hpp"

namespace radioslam {
namespace {

/// In doubles, because the difference of any two stamps may not fit a stamp.
bool is_far_behind(Stamp stamp, Stamp other) {
  return static_cast<double>(other.ns) - static_cast<double>(stamp.ns) >
         kLargestDisorder_s * static_cast<double>(kNanosecondsPerSecond);
}

}  // namespace

std::vector<std::size_t> rows_in_time_order(std::span<const Stamp> stamps) {
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  // last_of[n]: the row with the earliest time that ends an increasing subsequence of n + 1 rows.
  std::vector<std::size_t> last_of, previous(stamps.size(), kNone);
  for (std::size_t row = 0; row < stamps.size(); ++row) {
    const auto place =
        std::lower_bound(last_of.begin(), last_of.end(), stamps[row],
                         [&](std::size_t other, const Stamp& stamp) { return stamps[other] < stamp; });
    if (place != last_of.begin()) previous[row] = *(place - 1);
    if (place == last_of.end())
      last_of.push_back(row);
    else if (stamps[row] < stamps[*place])
      *place = row;
  }
  std::vector<std::size_t> rows(last_of.size());
  std::size_t row = last_of.empty() ? kNone : last_of.back();
  for (auto it = rows.rbegin(); it != rows.rend(); ++it, row = previous[row]) *it = row;
  return rows;
}

SortedRows sort_rows_by_time(std::span<const Stamp> stamps) {
  const std::vector<std::size_t> backbone = rows_in_time_order(stamps);
  SortedRows sorted;
  auto after = backbone.begin();  // the backbone's first row behind the current one
  for (std::size_t row = 0; row < stamps.size(); ++row) {
    const bool is_backbone = after != backbone.end() && *after == row;
    if (is_backbone) ++after;
    const bool is_late = after != backbone.end() && is_far_behind(stamps[*after], stamps[row]);
    const bool is_early = after != backbone.begin() && is_far_behind(stamps[row], stamps[*(after - 1)]);
    if (!is_backbone && (is_late || is_early))
      sorted.outside.push_back(row);
    else
      sorted.kept.push_back(row);
  }
  const auto earlier = [&](std::size_t a, std::size_t b) { return stamps[a] < stamps[b]; };
  for (std::size_t k = 1; k < sorted.kept.size(); ++k)
    if (earlier(sorted.kept[k], sorted.kept[k - 1])) ++sorted.moved;
  std::stable_sort(sorted.kept.begin(), sorted.kept.end(), earlier);
  return sorted;
}

}  // namespace radioslam
