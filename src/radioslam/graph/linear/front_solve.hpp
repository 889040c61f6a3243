// Substitution with the factor, front by front, on right-hand sides in elimination order.
#pragma once

#include <Eigen/Core>
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
  /// The front's part of x <- L^-T x; its parent's part comes before.
  void backward(const Front& front, double* x);
  /// The same for several right-hand sides, the rows of a column-major matrix.
  void backward(const Front& front, Eigen::MatrixXd& x);

 private:
  const FrontTree& tree_;
  const NumberStore& factor_;
  std::vector<double> rows_;  ///< the front's rows of x
};

}  // namespace radioslam
