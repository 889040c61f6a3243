// Substitution with the factor, front by front, on right-hand sides in elimination order.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "radioslam/graph/linear/front_kernels.hpp"
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
  /// The same for several right-hand sides, the rows of a matrix: a scalar's values are in column(scalar),
  /// and a front's pivots in successive columns.
  template <class Column>
  void backward(const Front& front, const Column& column, Eigen::MatrixXd& x) {
    const auto right_sides = static_cast<std::size_t>(x.rows());
    below_.resize(right_sides * front.below);
    for_each_block_below(tree_, front, [&](std::size_t row, std::size_t scalar, std::size_t count, auto) {
      for (std::size_t k = 0; k < count; ++k)
        std::copy_n(x.data() + column(scalar + k) * right_sides, right_sides,
                    below_.data() + (row - front.pivots + k) * right_sides);
    });
    front_kernels().solve_back({front.pivots, front.below}, factor_.data() + front.panel, right_sides,
                               below_.data(), x.data() + column(front.first_scalar) * right_sides);
  }
  /// L^-1 times the unit vector of a scalar that `front` eliminates. Only fronts on the way from there to the
  /// root have other values than zero; of them those up to the first for which on_path(front) is false are
  /// computed. A scalar's value is put into result[column(scalar)].
  template <class OnPath, class Column>
  void forward_unit(std::size_t scalar, std::uint32_t front, const OnPath& on_path, const Column& column,
                    Eigen::MatrixXd::RowXpr result) {
    unit_.resize(tree_.scalars(), 0.0);
    unit_[scalar] = 1;
    const auto is_wanted = [&](std::uint32_t f) { return f != kNoParent && on_path(f); };
    for (auto f = front; is_wanted(f); f = tree_.fronts[f].parent) forward(tree_.fronts[f], unit_.data());
    for (auto f = front; is_wanted(f); f = tree_.fronts[f].parent) {
      const Front& own = tree_.fronts[f];
      for (std::size_t k = own.first_scalar; k < own.first_scalar + own.pivots; ++k) {
        result[index(column(k))] = unit_[k];
        unit_[k] = 0;
      }
      for_each_block_below(tree_, own, [&](std::size_t, std::size_t first, std::size_t count, auto above) {
        if (!is_wanted(above)) std::fill_n(unit_.data() + first, count, 0.0);
      });
    }
  }

 private:
  const FrontTree& tree_;
  const NumberStore& factor_;
  std::vector<double> rows_;   ///< the front's rows of x
  std::vector<double> below_;  ///< the rows below its pivots, of several right-hand sides
  std::vector<double> unit_;   ///< zero but while a unit vector is solved for
};

}  // namespace radioslam
