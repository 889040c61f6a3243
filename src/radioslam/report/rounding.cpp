#include "radioslam/report/rounding.hpp"

#include <algorithm>

#include "radioslam/base/check.hpp"

namespace radioslam {

std::vector<std::size_t> evenly_spaced(std::size_t count, std::size_t limit) {
  RADIOSLAM_CHECK(limit >= 2, "thinning keeps both ends");
  const std::size_t kept = std::min(count, limit);
  std::vector<std::size_t> indices(kept);
  for (std::size_t i = 0; i < kept; ++i) indices[i] = kept == count ? i : i * (count - 1) / (kept - 1);
  return indices;
}

std::size_t part_of_budget(std::size_t count, std::size_t total, std::size_t budget, std::size_t least) {
  if (total <= budget) return std::max(count, least);
  const double ratio = static_cast<double>(count) / static_cast<double>(total);
  return std::max(static_cast<std::size_t>(ratio * static_cast<double>(budget)), least);
}

std::size_t nearest_kept(const std::vector<std::size_t>& kept, std::size_t index) {
  RADIOSLAM_CHECK(!kept.empty(), "nothing was kept");
  const auto after = std::lower_bound(kept.begin(), kept.end(), index);
  if (after == kept.end()) return kept.size() - 1;
  const auto place = static_cast<std::size_t>(after - kept.begin());
  const bool before_is_nearer = place > 0 && index - kept[place - 1] < *after - index;
  return before_is_nearer ? place - 1 : place;
}

}  // namespace radioslam
