#include "radioslam/graph/linear/front_solve.hpp"

#include <algorithm>

namespace radioslam {
namespace {

/// In four interleaved sums, which the processor can add side by side.
double dot(const double* a, const double* b, std::size_t count) {
  double sums[4] = {0, 0, 0, 0};
  std::size_t i = 0;
  for (; i + 4 <= count; i += 4) {
    for (std::size_t t = 0; t < 4; ++t) sums[t] += a[i + t] * b[i + t];
  }
  for (; i < count; ++i) sums[0] += a[i] * b[i];
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

}  // namespace

FrontSolver::FrontSolver(const FrontTree& tree, const NumberStore& factor)
    : tree_(tree), factor_(factor), rows_(tree.largest_front) {}

void FrontSolver::forward(const Front& front, double* x) {
  const std::size_t p = front.pivots, n = front.scalars();
  double* const rows = rows_.data();
  std::copy_n(x + front.first_scalar, p, rows);
  std::fill_n(rows + p, n - p, 0.0);
  for (std::size_t j = 0; j < p; ++j) {
    const double* const column = factor_.data() + front.panel + j * n;
    const double value = rows[j] / column[j];
    rows[j] = value;
    for (std::size_t i = j + 1; i < n; ++i) rows[i] -= column[i] * value;
  }
  std::copy_n(rows, p, x + front.first_scalar);
  for_each_block_below(tree_, front, [&](std::size_t row, std::size_t scalar, std::size_t count, auto) {
    for (std::size_t i = 0; i < count; ++i) x[scalar + i] += rows[row + i];
  });
}

void FrontSolver::backward(const Front& front, double* x) {
  const std::size_t p = front.pivots, n = front.scalars();
  double* const rows = rows_.data();
  std::copy_n(x + front.first_scalar, p, rows);
  for_each_block_below(tree_, front, [&](std::size_t row, std::size_t scalar, std::size_t count, auto) {
    for (std::size_t i = 0; i < count; ++i) rows[row + i] = x[scalar + i];
  });
  for (std::size_t j = p; j-- > 0;) {
    const double* const column = factor_.data() + front.panel + j * n;
    rows[j] = (rows[j] - dot(column + j + 1, rows + j + 1, n - j - 1)) / column[j];
  }
  std::copy_n(rows, p, x + front.first_scalar);
}

}  // namespace radioslam
