#include "radioslam/graph/linear/selected_inverse.hpp"

#include <algorithm>

#include "radioslam/base/check.hpp"
#include "radioslam/graph/linear/front_kernels.hpp"

namespace radioslam {
namespace {

/// A front's covariances while the fronts below it are being computed.
struct ParentFront {
  const double* panel = nullptr;  ///< pivots with all rows
  const double* below = nullptr;  ///< the other rows with each other, full
  std::size_t pivots = 0, rows = 0;

  /// Column `c` of the front from row `first` on, both inside or both below the pivots, or c a pivot.
  const double* column(std::size_t c, std::size_t first) const {
    return c < pivots ? panel + c * rows + first : below + (c - pivots) * (rows - pivots) + (first - pivots);
  }
};

/// The full covariance of a front's rows below, out of the parent front: columns that are pivots of the
/// parent whole, the rest from the parent's rows below, and the corner above them by symmetry.
void gather_below(const FrontTree& tree, const Front& front, const ParentFront& parent, double* below) {
  const auto n = front.below, split = front.below_in_pivots;
  for (auto c = front.runs.begin; c < front.runs.end; ++c) {
    const auto& column = tree.runs[c];
    const bool is_pivot = column.row < split;
    for (std::size_t t = 0; t < column.length; ++t) {
      double* to = below + (column.row + t) * n;
      for (auto k = front.runs.begin; k < front.runs.end; ++k) {
        const auto& row = tree.runs[k];
        if (!is_pivot && row.row < split) continue;
        std::copy_n(parent.column(column.parent_row + t, row.parent_row), row.length, to + row.row);
      }
    }
  }
  for (std::size_t j = split; j < n; ++j) {
    for (std::size_t i = 0; i < split; ++i) below[i + j * n] = below[j + i * n];
  }
}

}  // namespace

std::shared_ptr<const SelectedInverse::Impl> invert(std::shared_ptr<const FrontTree> tree,
                                                    const NumberStore& factor, NumberStore& stack) {
  auto inverse = std::make_shared<SelectedInverse::Impl>();
  inverse->panels = NumberStore(tree->factor_scalars);
  NumberStore scratch(tree->largest_panel);
  for (auto front = tree->fronts.rbegin(); front != tree->fronts.rend(); ++front) {
    double* const below = stack.data() + front->covariance;
    if (front->parent != kNoParent) {
      const auto& up = tree->fronts[front->parent];
      gather_below(*tree, *front,
                   {inverse->panels.data() + up.panel, stack.data() + up.covariance, up.pivots, up.scalars()},
                   below);
    }
    front_kernels().invert({front->pivots, front->below}, factor.data() + front->panel, below,
                           inverse->panels.data() + front->panel, scratch.data());
  }
  inverse->tree = std::move(tree);
  return inverse;
}

SelectedInverse::SelectedInverse(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

Eigen::MatrixXd SelectedInverse::diagonal(std::size_t i) const { return *block(i, i); }

std::optional<Eigen::MatrixXd> SelectedInverse::block(std::size_t i, std::size_t j) const {
  const auto& tree = *impl_->tree;
  RADIOSLAM_CHECK(i < tree.blocks() && j < tree.blocks(), "no such block");
  const auto row = std::max(tree.place[i], tree.place[j]), column = std::min(tree.place[i], tree.place[j]);
  const auto& front = tree.fronts[tree.front_of[column]];
  const auto start = find_row(tree, front, row);
  if (!start) return std::nullopt;
  const Eigen::Map<const Eigen::MatrixXd> panel(impl_->panels.data() + front.panel, index(front.scalars()),
                                                index(front.pivots));
  const auto values = panel.block(index(*start), index(tree.first_scalar[column] - front.first_scalar),
                                  index(tree.block_size(row)), index(tree.block_size(column)));
  if (row == tree.place[i]) return values;
  return values.transpose();
}

}  // namespace radioslam
