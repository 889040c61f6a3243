#include "radioslam/graph/linear/front_elimination.hpp"

#include <algorithm>

#include "radioslam/base/parallel.hpp"

namespace radioslam {
namespace {

/// A multiple of the rows of the kernels' tiles. Fewer rows would be spent on copying the columns, more would
/// leave threads without work.
constexpr std::size_t kRowsPerTask = 96;
/// Products of a front that takes a millisecond or two, some ten times what starting threads takes.
constexpr double kProductsToDivide = 1e7;

/// Calls body for ranges of at most kRowsPerTask of the rows, on several threads; the last rows, which have
/// most to do, first.
template <class Body>
void for_rows(FrontRange rows, const Body& body) {
  const std::size_t tasks = (rows.end - rows.begin + kRowsPerTask - 1) / kRowsPerTask;
  parallel_for(tasks, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t task = first; task < last; ++task) {
      const std::size_t begin = rows.begin + (tasks - 1 - task) * kRowsPerTask;
      body(FrontRange{begin, std::min(rows.end, begin + kRowsPerTask)});
    }
  });
}

double products(FrontShape shape) {
  const auto p = static_cast<double>(shape.pivots), r = static_cast<double>(shape.below);
  return p * (p * p / 3 + p * r + r * r) / 2;
}

}  // namespace

bool eliminate_front_in_steps(const FrontKernels& kernels, FrontShape shape, double* panel, double* update) {
  const std::size_t n = shape.pivots + shape.below;
  for (std::size_t k = 0; k < shape.pivots; k += kEliminatedTogether) {
    const FrontRange pivots{k, std::min(shape.pivots, k + kEliminatedTogether)}, below{pivots.end, n};
    if (!kernels.eliminate_pivots(shape, pivots, panel)) return false;
    for_rows(below, [&](FrontRange rows) { kernels.solve_rows(shape, pivots, rows, panel); });
    if (pivots.end < shape.pivots)
      for_rows(below, [&](FrontRange rows) { kernels.update_panel(shape, pivots, rows, panel); });
  }
  for_rows({0, shape.below}, [&](FrontRange rows) { kernels.update_below(shape, rows, panel, update); });
  return true;
}

bool eliminate_front(const FrontKernels& kernels, FrontShape shape, double* panel, double* update) {
  if (thread_count() == 1 || products(shape) < kProductsToDivide)
    return kernels.eliminate(shape, panel, update);
  return eliminate_front_in_steps(kernels, shape, panel, update);
}

}  // namespace radioslam
