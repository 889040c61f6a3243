// Substitution with the factor, front by front, on right-hand sides in elimination order.
#pragma once

#include <vector>

#include "radioslam/graph/linear/front_tree.hpp"
#include "radioslam/graph/linear/number_store.hpp"

namespace radioslam {

/// Refers to the tree and the factor: both must outlive it.
class FrontSolver {
 public:
  FrontSolver(const FrontTree& tree, const NumberStore& factor);

  /// The front's part of x <- L^-1 x; its children's parts come before.
  void forward(const Front& front, double* x);
  /// The front's part of x <- L^-T x for several right-hand sides, the k-th at x + k * stride; its parent's
  /// part comes before. Each is solved as if alone, but the factor is read once for all.
  void backward(const Front& front, double* x, std::size_t columns, std::size_t stride);

 private:
  const FrontTree& tree_;
  const NumberStore& factor_;
  std::vector<double> rows_;  ///< the front's rows of x
};

}  // namespace radioslam
