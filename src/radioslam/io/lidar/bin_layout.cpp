#include "radioslam/io/lidar/bin_layout.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "radioslam/io/text/byte_view.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMinPoints = 100, kMaxPoints = 2000;
constexpr double kMaxEqual = 0.04;      ///< distance of columns that are equal, for many points
constexpr double kMaxEqualNoise = 1.4;  ///< times sqrt(2 / points), what chance adds
constexpr double kMinDifferent = 0.3;   ///< of columns that differ

using Column = std::vector<float>;

/// Sorted values of the columns of points with this many floats; values that are not finite are left out.
std::vector<Column> columns_of(std::string_view bytes, std::size_t floats) {
  const ByteView view(bytes, ByteOrder::kLittle);
  std::vector<Column> columns(floats);
  const std::size_t points = std::min(bytes.size() / (floats * sizeof(float)), kMaxPoints);
  for (std::size_t k = 0; k < points * floats; ++k)
    if (const float value = view.f32(k * sizeof(float)); std::isfinite(value))
      columns[k % floats].push_back(value);
  for (Column& column : columns) std::sort(column.begin(), column.end());
  return columns;
}

/// Largest difference of the two empirical distribution functions.
double distance(const Column& a, const Column& b) {
  double greatest = 0;
  auto i = a.begin(), j = b.begin();
  while (i != a.end() && j != b.end()) {
    const float value = std::min(*i, *j);
    i = std::upper_bound(i, a.end(), value);
    j = std::upper_bound(j, b.end(), value);
    const double share_a = static_cast<double>(i - a.begin()) / static_cast<double>(a.size());
    const double share_b = static_cast<double>(j - b.begin()) / static_cast<double>(b.size());
    greatest = std::max(greatest, std::abs(share_a - share_b));
  }
  return greatest;
}

/// Whether columns that are a multiple of `apart` apart have one distribution.
bool are_equal(const std::vector<Column>& columns, std::size_t apart) {
  for (std::size_t a = 0; a < columns.size(); ++a)
    for (std::size_t b = a + apart; b < columns.size(); b += apart) {
      const std::size_t points = std::min(columns[a].size(), columns[b].size());
      if (points < kMinPoints) return false;
      const double chance = kMaxEqualNoise * std::sqrt(2 / static_cast<double>(points));
      if (distance(columns[a], columns[b]) > kMaxEqual + chance) return false;
    }
  return true;
}

bool are_different(const std::vector<Column>& columns) {
  for (std::size_t a = 1; a < columns.size(); ++a)
    if (distance(columns.front(), columns[a]) > kMinDifferent) return true;
  return false;
}

}  // namespace

std::size_t floats_per_point(std::string_view bytes) {
  std::vector<Column> as_four;
  for (const std::size_t floats : {5U, 3U, 6U, 7U}) {
    if (bytes.empty() || bytes.size() % (floats * sizeof(float)) != 0) continue;
    if (as_four.empty()) as_four = columns_of(bytes, kBinFloats);
    if (are_equal(as_four, std::gcd(floats, kBinFloats)) && are_different(columns_of(bytes, floats)))
      return floats;
  }
  return kBinFloats;
}

}  // namespace radioslam
