#include "radioslam/io/text/skipped_records.hpp"

#include <algorithm>
#include <limits>

namespace radioslam {

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

}  // namespace radioslam
