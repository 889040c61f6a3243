// Random polar grids for tests.
#pragma once

#include <Eigen/Core>

#include "radioslam/base/random.hpp"
#include "radioslam/places/scan_context.hpp"

namespace radioslam::test {

/// Bins and whole columns are empty with these ratios.
inline Eigen::MatrixXf random_bins(int rings, int sectors, double empty_bins, double empty_columns,
                                   Rng& rng) {
  Eigen::MatrixXf bins = Eigen::MatrixXf::Zero(rings, sectors);
  for (int j = 0; j < sectors; ++j) {
    if (rng.uniform() < empty_columns) continue;
    for (int i = 0; i < rings; ++i)
      if (rng.uniform() >= empty_bins) bins(i, j) = static_cast<float>(rng.uniform(0.01, 12));
  }
  return bins;
}

inline ScanContext random_context(int rings, int sectors, double empty_columns, Rng& rng) {
  return {random_bins(rings, sectors, 0.4, empty_columns, rng), ScanContextParams().min_common_ratio};
}

/// Column j becomes column j + shift.
inline Eigen::MatrixXf shifted(const Eigen::MatrixXf& bins, Eigen::Index shift) {
  Eigen::MatrixXf result(bins.rows(), bins.cols());
  for (Eigen::Index j = 0; j < bins.cols(); ++j) result.col((j + shift) % bins.cols()) = bins.col(j);
  return result;
}

}  // namespace radioslam::test
