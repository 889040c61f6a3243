// Scan Context's distance as in the paper: shift by shift, column by column. Referee of compare().
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "radioslam/places/scan_context.hpp"

namespace radioslam::test {

/// 1 - mean cosine of the columns that are not empty in both, per shift; 1 for shifts with too few of them.
inline std::vector<double> distances_by_shifts(const ScanContext& a, const ScanContext& b) {
  const int sectors = a.sectors(), min_common = std::max(a.min_common(), b.min_common());
  const Eigen::RowVectorXf norms_a = a.bins().colwise().norm(), norms_b = b.bins().colwise().norm();
  std::vector<double> distances;
  for (int shift = 0; shift < sectors; ++shift) {
    double sum = 0;
    int common = 0;
    for (int j = 0; j < sectors; ++j) {
      const int i = (j + shift) % sectors;
      if (norms_a[i] == 0 || norms_b[j] == 0) continue;
      sum += static_cast<double>(a.bins().col(i).dot(b.bins().col(j)) / (norms_a[i] * norms_b[j]));
      ++common;
    }
    distances.push_back(common < min_common ? 1 : 1 - sum / common);
  }
  return distances;
}

inline double distance_by_shifts(const ScanContext& a, const ScanContext& b) {
  const std::vector<double> distances = distances_by_shifts(a, b);
  return *std::min_element(distances.begin(), distances.end());
}

}  // namespace radioslam::test
