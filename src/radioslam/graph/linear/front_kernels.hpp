// The dense arithmetic of one front, where nearly all the time goes.
// Matrices are column-major; a panel of p pivot and r further rows is (p + r) x p with L_PP above L_RP.
// There is one set of kernels per instruction set; all give the same bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace radioslam {

struct FrontShape {
  std::size_t pivots = 0;  ///< p
  std::size_t below = 0;   ///< r
};

/// Successive rows or columns [begin, end).
struct FrontRange {
  std::size_t begin = 0, end = 0;
};

/// Pivots eliminated before the columns right of them are brought up to date.
inline constexpr std::size_t kEliminatedTogether = 96;

/// The columns `which` of a matrix.
struct PickedMatrix {
  const double* data = nullptr;
  std::size_t rows = 0;
  const std::uint32_t* which = nullptr;
  std::size_t columns = 0;  ///< how many are picked
};

struct FrontKernels {
  const char* instruction_set;

  /// Panel <- [L_PP; L_RP] of its lower trapezoid; update <- -L_RP L_RP^T (r x r, lower triangle).
  /// Entries above the diagonals are overwritten or left unchanged. False when a pivot is not positive;
  /// the contents are then of no use.
  bool (*eliminate)(FrontShape shape, double* panel, double* update);

  /// `eliminate` in steps, with the same bytes (front_elimination.hpp): for each range of pivots in turn,
  /// their triangle; every row below it; every row's columns up to the last pivot. Then the rows of `update`.
  /// What takes `rows` writes only those, so that several may be computed at a time; rows are counted from
  /// the first of the panel, or of `update`.
  bool (*eliminate_pivots)(FrontShape shape, FrontRange pivots, double* panel);
  void (*solve_rows)(FrontShape shape, FrontRange pivots, FrontRange rows, double* panel);
  void (*update_panel)(FrontShape shape, FrontRange pivots, FrontRange rows, double* panel);
  void (*update_below)(FrontShape shape, FrontRange rows, const double* panel, double* update);

  /// Covariances of a front's pivots with all its rows: from the factor's panel and the full r x r
  /// covariance of the rows below, Z_RP = -Z_RR Y and Z_PP = L_PP^-T L_PP^-1 - Y^T Z_RP with
  /// Y = L_RP L_PP^-1. Z_PP is full. `scratch` holds p (p + r) numbers.
  void (*invert)(FrontShape shape, const double* panel, const double* covariance_below,
                 double* covariance_panel, double* scratch);

  /// Back substitution for several right-hand sides, which are rows here: pivots <- (pivots - below L_RP)
  /// L_PP^-1, with `pivots` a rows x p and `below` a rows x r matrix.
  void (*solve_back)(FrontShape shape, const double* panel, std::size_t rows, const double* below,
                     double* pivots);

  /// C <- A B for columns of a matrix, with B and C without gaps between their columns.
  void (*multiply)(PickedMatrix a, std::size_t columns, const double* b, double* c);
};

/// All that this machine can run, the fastest first.
std::vector<FrontKernels> available_front_kernels();
/// The fastest of them.
const FrontKernels& front_kernels();

// The sets of kernels this program was built with.

FrontKernels front_kernels_two_doubles();
FrontKernels front_kernels_four_doubles();  ///< x86-64 only

}  // namespace radioslam
