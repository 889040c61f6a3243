// The dense arithmetic of one front, where nearly all the time goes.
// Matrices are column-major; a panel of p pivot and r further rows is (p + r) x p with L_PP above L_RP.
// There is one set of kernels per instruction set; all give the same bytes.
#pragma once

#include <cstddef>
#include <vector>

namespace radioslam {

struct FrontShape {
  std::size_t pivots = 0;  ///< p
  std::size_t below = 0;   ///< r
};

struct FrontKernels {
  const char* instruction_set;

  /// Panel <- [L_PP; L_RP] of its lower trapezoid; update <- -L_RP L_RP^T (r x r, lower triangle).
  /// Entries above the diagonals are overwritten or left unchanged. False when a pivot is not positive;
  /// the contents are then of no use.
  bool (*eliminate)(FrontShape shape, double* panel, double* update);

  /// Covariances of a front's pivots with all its rows: from the factor's panel and the full r x r
  /// covariance of the rows below, Z_RP = -Z_RR Y and Z_PP = L_PP^-T L_PP^-1 - Y^T Z_RP with
  /// Y = L_RP L_PP^-1. Z_PP is full. `scratch` holds p (p + r) numbers.
  void (*invert)(FrontShape shape, const double* panel, const double* covariance_below,
                 double* covariance_panel, double* scratch);

  /// Back substitution for several right-hand sides, which are rows here: pivots <- (pivots - below L_RP)
  /// L_PP^-1, with `pivots` a rows x p and `below` a rows x r matrix.
  void (*solve_back)(FrontShape shape, const double* panel, std::size_t rows, const double* below,
                     double* pivots);
};

/// All that this machine can run, the fastest first.
std::vector<FrontKernels> available_front_kernels();
/// The fastest of them.
const FrontKernels& front_kernels();

}  // namespace radioslam
