// The kernels of front_kernels.hpp for one vector type. Included by one source file per instruction set.
#pragma once

#include "radioslam/graph/linear/dense_product.hpp"
#include "radioslam/graph/linear/front_kernels.hpp"

namespace radioslam::dense {

template <class Simd>
struct DenseFront {
  /// Cholesky of a kColumns x kColumns lower triangle. False when a pivot is not positive or not finite.
  template <std::size_t kColumns>
  static bool factor_triangle(double* l, std::size_t stride, double* reciprocals) {
    for (std::size_t j = 0; j < kColumns; ++j) {
      for (std::size_t d = 0; d < j; ++d) {
        for (std::size_t i = j; i < kColumns; ++i) l[i + j * stride] -= l[i + d * stride] * l[j + d * stride];
      }
      const double pivot = l[j + j * stride];
      if (!(pivot > 0 && pivot <= __DBL_MAX__)) return false;
      const double root = __builtin_sqrt(pivot);
      reciprocals[j] = 1 / root;
      l[j + j * stride] = root;
      for (std::size_t i = j + 1; i < kColumns; ++i) l[i + j * stride] *= reciprocals[j];
    }
    return true;
  }

  /// A strip of columns of the panel, all rows from the diagonal down; `inner` columns left of it still have
  /// to be subtracted.
  template <std::size_t kColumns>
  static bool factor_strip(std::size_t rows, std::size_t inner, double* diagonal, std::size_t stride) {
    const Columns left{diagonal - inner * stride, stride};
    const Strided right{diagonal - inner * stride, stride, 1};
    compute_strip<Simd, Operation::kSubtract, kColumns>(0, {kColumns, kColumns, inner}, Left::kFull, left,
                                                        right, {diagonal, stride});
    double reciprocals[kColumns];
    if (!factor_triangle<kColumns>(diagonal, stride, reciprocals)) return false;
    compute_strip<Simd, Operation::kSubtractAndSolve, kColumns>(kColumns, {rows, kColumns, inner},
                                                                Left::kFull, left, right, {diagonal, stride},
                                                                {diagonal, stride, reciprocals});
    return true;
  }

  static bool factor_panel(std::size_t rows, std::size_t columns, double* panel, std::size_t stride) {
    bool positive = true;
    for_each_strip(columns, [&](std::size_t j, auto width) {
      constexpr std::size_t kColumns = decltype(width)::value;
      positive = positive && factor_strip<kColumns>(rows - j, j, panel + j + j * stride, stride);
    });
    return positive;
  }

  static bool eliminate(FrontShape shape, double* panel, double* update) {
    const std::size_t p = shape.pivots, r = shape.below, n = p + r;
    for (std::size_t k = 0; k < p; k += kEliminatedTogether) {
      const std::size_t width = p - k < kEliminatedTogether ? p - k : kEliminatedTogether;
      const std::size_t next = k + width;
      if (!factor_panel(n - k, width, panel + k + k * n, n)) return false;
      const double* const done = panel + next + k * n;
      product<Simd, Operation::kSubtract>({n - next, p - next, width}, Shape::kLowerResult, Left::kFull,
                                          {done, n}, {done, n, 1}, {panel + next + next * n, n});
    }
    product<Simd, Operation::kAssignNegative>({r, r, p}, Shape::kLowerResult, Left::kFull, {panel + p, n},
                                              {panel + p, n, 1}, {update, r});
    return true;
  }

  /// The steps of `eliminate` for pivots [k, k + width), whose columns are up to date; see FrontKernels.
  static bool eliminate_pivots(FrontShape shape, FrontRange pivots, double* panel) {
    const std::size_t n = shape.pivots + shape.below, width = pivots.end - pivots.begin;
    return factor_panel(width, width, panel + pivots.begin + pivots.begin * n, n);
  }

  static void solve_rows(FrontShape shape, FrontRange pivots, FrontRange rows, double* panel) {
    const std::size_t n = shape.pivots + shape.below;
    double* const left = panel + pivots.begin * n;
    for_each_strip(pivots.end - pivots.begin, [&](std::size_t j, auto width) {
      constexpr std::size_t kColumns = decltype(width)::value;
      const double* const diagonal = left + pivots.begin + j + j * n;
      double reciprocals[kColumns];
      for (std::size_t t = 0; t < kColumns; ++t) reciprocals[t] = 1 / diagonal[t + t * n];
      compute_strip<Simd, Operation::kSubtractAndSolve, kColumns>(
          0, {rows.end - rows.begin, kColumns, j}, Left::kFull, {left + rows.begin, n},
          {left + pivots.begin + j, n, 1}, {left + rows.begin + j * n, n}, {diagonal, n, reciprocals});
    });
  }

  static void update_panel(FrontShape shape, FrontRange pivots, FrontRange rows, double* panel) {
    const std::size_t n = shape.pivots + shape.below, next = pivots.end;
    const double* const done = panel + next + pivots.begin * n;
    product_of_rows<Simd, Operation::kSubtract>(
        rows.begin - next, rows.end - next, {n - next, shape.pivots - next, next - pivots.begin},
        Shape::kLowerResult, Left::kFull, Columns{done, n}, {done, n, 1}, {panel + next + next * n, n});
  }

  static void update_below(FrontShape shape, FrontRange rows, const double* panel, double* update) {
    const std::size_t p = shape.pivots, r = shape.below, n = p + r;
    product_of_rows<Simd, Operation::kAssignNegative>(rows.begin, rows.end, {r, r, p}, Shape::kLowerResult,
                                                      Left::kFull, Columns{panel + p, n}, {panel + p, n, 1},
                                                      {update, r});
  }

  /// Columns [first, first + columns) of W = L_PP^-T, where -W L^T of the columns before is already in the
  /// rows above `first` and the identity in the square at the diagonal.
  static void invert_columns(std::size_t first, std::size_t columns, const double* panel, std::size_t stride,
                             double* w, std::size_t p) {
    double* const strip = w + first * p;
    double* const square = strip + first;
    const double* const pivots = panel + first + first * stride;
    for_each_strip(columns, [&](std::size_t j, auto width) {
      constexpr std::size_t kColumns = decltype(width)::value;
      const double* const diagonal = pivots + j + j * stride;
      double reciprocals[kColumns];
      for (std::size_t t = 0; t < kColumns; ++t) reciprocals[t] = 1 / diagonal[t + t * stride];
      const TileSolver solver{diagonal, stride, reciprocals};
      const Strided left_of_diagonal{pivots + j, stride, 1};
      compute_strip<Simd, Operation::kSubtractAndSolve, kColumns>(
          0, {first, kColumns, j}, Left::kFull, {strip, p}, left_of_diagonal, {strip + j * p, p}, solver);
      compute_strip<Simd, Operation::kSubtractAndSolve, kColumns>(0, {j + kColumns, kColumns, j},
                                                                  Left::kUpper, {square, p}, left_of_diagonal,
                                                                  {square + j * p, p}, solver);
    });
  }

  /// L_PP^-T, upper triangular with its zeros, p x p.
  static void invert_transposed(FrontShape shape, const double* panel, double* w) {
    const std::size_t p = shape.pivots, n = p + shape.below;
    for (std::size_t i = 0; i < p * p; ++i) w[i] = 0;
    for (std::size_t i = 0; i < p; ++i) w[i + i * p] = 1;
    for (std::size_t k = 0; k < p; k += kEliminatedTogether) {
      const std::size_t columns = p - k < kEliminatedTogether ? p - k : kEliminatedTogether;
      product<Simd, Operation::kAssignNegative>({k, columns, k}, Shape::kFull, Left::kUpper, {w, p},
                                                {panel + k, n, 1}, {w + k * p, p});
      invert_columns(k, columns, panel, n, w, p);
    }
  }

  static void mirror_lower(std::size_t size, double* matrix, std::size_t stride) {
    for (std::size_t j = 0; j < size; ++j) {
      for (std::size_t i = j + 1; i < size; ++i) matrix[j + i * stride] = matrix[i + j * stride];
    }
  }

  /// With W = L_PP^-T and N = -Y^T = -W L_RP^T: Z_RP = Z_RR N^T, Z_PP = W W^T + N Z_RP.
  static void invert(FrontShape shape, const double* panel, const double* covariance_below,
                     double* covariance_panel, double* scratch) {
    const std::size_t p = shape.pivots, r = shape.below, n = p + r;
    double* const w = scratch;
    double* const y = scratch + p * p;
    invert_transposed(shape, panel, w);
    product<Simd, Operation::kAssignNegative>({p, r, p}, Shape::kFull, Left::kUpper, {w, p},
                                              {panel + p, n, 1}, {y, p});
    product<Simd, Operation::kAssign>({r, p, r}, Shape::kFull, Left::kFull, {covariance_below, r}, {y, p, 1},
                                      {covariance_panel + p, n});
    product<Simd, Operation::kAssign>({p, p, p}, Shape::kLowerResult, Left::kUpper, {w, p}, {w, p, 1},
                                      {covariance_panel, n});
    product<Simd, Operation::kAdd>({p, p, r}, Shape::kLowerResult, Left::kFull, {y, p},
                                   {covariance_panel + p, 1, n}, {covariance_panel, n});
    mirror_lower(p, covariance_panel, n);
  }

  /// Y L = C for a small lower triangular L, from C in place.
  static void solve_square(std::size_t columns, const double* l, std::size_t stride, std::size_t rows,
                           double* y) {
    for (std::size_t j = columns; j-- > 0;) {
      double* const own = y + j * rows;
      for (std::size_t i = j + 1; i < columns; ++i) {
        const double factor = l[i + j * stride];
        const double* const later = y + i * rows;
        for (std::size_t t = 0; t < rows; ++t) own[t] -= later[t] * factor;
      }
      const double reciprocal = 1 / l[j + j * stride];
      for (std::size_t t = 0; t < rows; ++t) own[t] *= reciprocal;
    }
  }

  static void solve_back(FrontShape shape, const double* panel, std::size_t rows, const double* below,
                         double* pivots) {
    constexpr std::size_t kStrip = 6;
    const std::size_t p = shape.pivots, r = shape.below, n = p + r;
    if (r > 0)
      product<Simd, Operation::kSubtract>({rows, p, r}, Shape::kFull, Left::kFull, {below, rows},
                                          {panel + p, 1, n}, {pivots, rows});
    for (std::size_t end = p; end > 0;) {
      const std::size_t width = end < kStrip ? end : kStrip, first = end - width;
      const double* const strip = panel + first * n;
      if (end < p)
        product<Simd, Operation::kSubtract>({rows, width, p - end}, Shape::kFull, Left::kFull,
                                            {pivots + end * rows, rows}, {strip + end, 1, n},
                                            {pivots + first * rows, rows});
      solve_square(width, strip + first, n, rows, pivots + first * rows);
      end = first;
    }
  }

  static void multiply(PickedMatrix a, std::size_t columns, const double* b, double* c) {
    product_of_rows<Simd, Operation::kAssign>(0, a.rows, {a.rows, columns, a.columns}, Shape::kFull,
                                              Left::kFull, PickedColumns{a.data, a.rows, a.which},
                                              {b, 1, a.columns}, {c, a.rows});
  }

  static constexpr FrontKernels kernels(const char* name) {
    return {name,          &eliminate, &eliminate_pivots, &solve_rows, &update_panel,
            &update_below, &invert,    &solve_back,       &multiply};
  }
};

}  // namespace radioslam::dense
