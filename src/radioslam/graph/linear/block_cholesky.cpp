#include "radioslam/graph/linear/block_cholesky.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/base/check.hpp"
#include "radioslam/graph/linear/front_elimination.hpp"
#include "radioslam/graph/linear/front_kernels.hpp"
#include "radioslam/graph/linear/front_solve.hpp"
#include "radioslam/graph/linear/front_tree.hpp"
#include "radioslam/graph/linear/selected_inverse.hpp"

namespace radioslam {
namespace {

using ConstPanel = Eigen::Map<const Eigen::MatrixXd>;

/// target(parent rows, parent columns) += lower triangle of a child's update matrix, for the columns of the
/// runs [begin, end). `row_shift` is what target's first row and column are called in the parent front.
void add_columns(const FrontTree& tree, const Front& child, const double* update, Range columns,
                 double* target, std::size_t target_rows, std::size_t row_shift, std::size_t column_shift) {
  for (auto c = columns.begin; c < columns.end; ++c) {
    const auto& column = tree.runs[c];
    for (std::size_t t = 0; t < column.length; ++t) {
      const double* from = update + (column.row + t) * child.below;
      double* to = target + (column.parent_row + t - column_shift) * target_rows;
      for (auto k = c; k < child.runs.end; ++k) {
        const auto& row = tree.runs[k];
        const std::size_t skip = k == c ? t : 0;
        const double* source = from + row.row;
        double* sum = to + (row.parent_row - row_shift);
        for (std::size_t i = skip; i < row.length; ++i) sum[i] += source[i];
      }
    }
  }
}

/// First run of a child that is below the parent's pivots.
std::size_t first_run_below(const FrontTree& tree, const Front& child) {
  auto k = child.runs.begin;
  while (k < child.runs.end && tree.runs[k].row < child.below_in_pivots) ++k;
  return k;
}

}  // namespace

struct BlockCholesky::Impl {
  BlockPattern pattern;
  std::shared_ptr<const FrontTree> tree;
  NumberStore factor;
  NumberStore stack;  ///< update matrices while factorising, covariances while inverting; empty until then
  bool usable = false;

  void load_blocks(const SymmetricBlockMatrix& matrix, const Front& front);
  void add_children_to_pivots(const Front& front);
  void add_children_to_update(const Front& front);
  bool eliminate(const SymmetricBlockMatrix& matrix, const Front& front);

  ConstPanel panel(const Front& front) const {
    return {factor.data() + front.panel, index(front.scalars()), index(front.pivots)};
  }
  /// The columns of x from the blocks' scalars in one order to those in the other.
  Eigen::MatrixXd in_elimination_order(const Eigen::MatrixXd& x) const {
    return moved(x, tree->original_scalar, tree->first_scalar);
  }
  Eigen::MatrixXd in_original_order(const Eigen::MatrixXd& x) const {
    return moved(x, tree->first_scalar, tree->original_scalar);
  }
  Eigen::MatrixXd moved(const Eigen::MatrixXd& x, const std::vector<std::size_t>& from,
                        const std::vector<std::size_t>& to) const;
  void provide_stack() {
    if (stack.size() == 0) stack = NumberStore(std::max(tree->stack_scalars, tree->covariance_scalars));
  }
  void check_usable() const { RADIOSLAM_CHECK(usable, "there is no factor to use"); }
};

void BlockCholesky::Impl::load_blocks(const SymmetricBlockMatrix& matrix, const Front& front) {
  const auto n = pattern.blocks();
  for (auto s = front.slots.begin; s < front.slots.end; ++s) {
    const auto& slot = tree->slots[s];
    const bool is_diagonal = slot.block < n;
    const auto source = is_diagonal ? matrix.diagonal(slot.block) : matrix.lower(slot.block - n);
    double* to = factor.data() + slot.destination;
    const auto rows = slot.transposed ? source.cols() : source.rows();
    const auto columns = slot.transposed ? source.rows() : source.cols();
    for (Eigen::Index j = 0; j < columns; ++j) {
      for (Eigen::Index i = is_diagonal ? j : 0; i < rows; ++i) {
        to[i + j * index(front.scalars())] = slot.transposed ? source(j, i) : source(i, j);
      }
    }
  }
}

void BlockCholesky::Impl::add_children_to_pivots(const Front& front) {
  for (auto c = front.children.begin; c < front.children.end; ++c) {
    const auto& child = tree->fronts[tree->children[c]];
    add_columns(*tree, child, stack.data() + child.update, {child.runs.begin, first_run_below(*tree, child)},
                factor.data() + front.panel, front.scalars(), 0, 0);
  }
}

void BlockCholesky::Impl::add_children_to_update(const Front& front) {
  for (auto c = front.children.begin; c < front.children.end; ++c) {
    const auto& child = tree->fronts[tree->children[c]];
    add_columns(*tree, child, stack.data() + child.update, {first_run_below(*tree, child), child.runs.end},
                stack.data() + front.update, front.below, front.pivots, front.pivots);
  }
}

bool BlockCholesky::Impl::eliminate(const SymmetricBlockMatrix& matrix, const Front& front) {
  double* const panel_begin = factor.data() + front.panel;
  std::fill_n(panel_begin, front.scalars() * front.pivots, 0.0);
  load_blocks(matrix, front);
  add_children_to_pivots(front);
  if (!eliminate_front(front_kernels(), {front.pivots, front.below}, panel_begin,
                       stack.data() + front.update))
    return false;
  add_children_to_update(front);
  return true;
}

Eigen::MatrixXd BlockCholesky::Impl::moved(const Eigen::MatrixXd& x, const std::vector<std::size_t>& from,
                                           const std::vector<std::size_t>& to) const {
  Eigen::MatrixXd result(x.rows(), x.cols());
  for (std::size_t at = 0; at < tree->blocks(); ++at) {
    const auto size = index(tree->block_size(at));
    result.middleCols(index(to[at]), size) = x.middleCols(index(from[at]), size);
  }
  return result;
}

BlockCholesky::BlockCholesky(const BlockPattern& pattern, const BlockCholeskyOptions& options)
    : impl_(std::make_unique<Impl>()) {
  impl_->pattern = pattern;
  impl_->tree = std::make_shared<const FrontTree>(front_tree(pattern, options));
  impl_->factor = NumberStore(impl_->tree->factor_scalars);
}
BlockCholesky::~BlockCholesky() = default;
BlockCholesky::BlockCholesky(BlockCholesky&&) noexcept = default;
BlockCholesky& BlockCholesky::operator=(BlockCholesky&&) noexcept = default;

Factorization BlockCholesky::factorize(const SymmetricBlockMatrix& matrix) {
  RADIOSLAM_CHECK(
      matrix.pattern().sizes == impl_->pattern.sizes && matrix.pattern().lower == impl_->pattern.lower,
      "the matrix has another pattern than was analysed");
  impl_->usable = false;
  impl_->provide_stack();
  for (const auto& front : impl_->tree->fronts) {
    if (!impl_->eliminate(matrix, front)) return Factorization::kNotPositiveDefinite;
  }
  impl_->usable = true;
  return Factorization::kDone;
}

Eigen::VectorXd BlockCholesky::solve(const Eigen::VectorXd& b) const {
  impl_->check_usable();
  RADIOSLAM_CHECK(b.size() == index(impl_->tree->scalars()), "the right-hand side has another length");
  FrontSolver solver(*impl_->tree, impl_->factor);
  Eigen::MatrixXd x = impl_->in_elimination_order(b.transpose());
  const auto& fronts = impl_->tree->fronts;
  for (const auto& front : fronts) solver.forward(front, x.data());
  for (auto front = fronts.rbegin(); front != fronts.rend(); ++front) solver.backward(*front, x.data());
  return impl_->in_original_order(x).transpose();
}

Eigen::MatrixXd BlockCholesky::inverse_rows(const std::vector<std::size_t>& blocks) const {
  impl_->check_usable();
  const auto& tree = *impl_->tree;
  Eigen::Index rows = 0;
  for (const std::size_t block : blocks) {
    RADIOSLAM_CHECK(block < tree.blocks(), "no such block");
    rows += index(tree.block_size(tree.place[block]));
  }
  const auto column = [](std::size_t scalar) { return scalar; };
  const auto to_the_root = [](std::uint32_t) { return true; };
  FrontSolver solver(tree, impl_->factor);
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(rows, index(tree.scalars()));
  Eigen::Index row = 0;
  for (const std::size_t block : blocks) {
    const std::size_t at = tree.place[block];
    for (std::size_t k = tree.first_scalar[at]; k < tree.first_scalar[at + 1]; ++k)
      solver.forward_unit(k, tree.front_of[at], to_the_root, column, x.row(row++));
  }
  for (auto front = tree.fronts.rbegin(); front != tree.fronts.rend(); ++front)
    solver.backward(*front, column, x);
  return impl_->in_original_order(x);
}

Eigen::MatrixXd BlockCholesky::inverse_between(const std::vector<std::size_t>& blocks) const {
  impl_->check_usable();
  const FrontTree& tree = *impl_->tree;
  std::vector<bool> is_on_way(tree.fronts.size(), false);
  Eigen::Index rows = 0;
  for (const std::size_t block : blocks) {
    RADIOSLAM_CHECK(block < tree.blocks(), "no such block");
    rows += index(tree.block_size(tree.place[block]));
    for (auto f = tree.front_of[tree.place[block]]; f != kNoParent && !is_on_way[f];
         f = tree.fronts[f].parent)
      is_on_way[f] = true;
  }
  std::vector<std::size_t> columns(tree.scalars());
  std::size_t used = 0;
  for (std::size_t f = 0; f < tree.fronts.size(); ++f)
    for (std::size_t k = 0; is_on_way[f] && k < tree.fronts[f].pivots; ++k)
      columns[tree.fronts[f].first_scalar + k] = used++;
  const auto column = [&](std::size_t scalar) { return columns[scalar]; };
  const auto to_the_root = [](std::uint32_t) { return true; };
  FrontSolver solver(tree, impl_->factor);
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(rows, index(used));
  std::vector<std::size_t> scalars;
  for (const std::size_t block : blocks) {
    const std::size_t at = tree.place[block];
    for (std::size_t k = tree.first_scalar[at]; k < tree.first_scalar[at + 1]; ++k) {
      solver.forward_unit(k, tree.front_of[at], to_the_root, column, x.row(index(scalars.size())));
      scalars.push_back(k);
    }
  }
  for (std::size_t f = tree.fronts.size(); f-- > 0;)
    if (is_on_way[f]) solver.backward(tree.fronts[f], column, x);
  Eigen::MatrixXd result(rows, rows);
  for (Eigen::Index k = 0; k < rows; ++k)
    result.col(k) = x.col(index(column(scalars[static_cast<std::size_t>(k)])));
  return result;
}

double BlockCholesky::log_determinant() const {
  impl_->check_usable();
  double sum = 0;
  for (const auto& front : impl_->tree->fronts) {
    const auto L = impl_->panel(front);
    for (Eigen::Index k = 0; k < index(front.pivots); ++k) sum += 2 * std::log(L(k, k));
  }
  return sum;
}

SelectedInverse BlockCholesky::selected_inverse() const {
  impl_->check_usable();
  impl_->provide_stack();
  return SelectedInverse(invert(impl_->tree, impl_->factor, impl_->stack));
}

PartitionedInverse BlockCholesky::partitioned_inverse(std::size_t part_scalars) const {
  impl_->check_usable();
  impl_->stack = {};  // a partition is kept for long, and takes none of it
  return {*impl_->tree, impl_->factor, part_scalars};
}

double BlockCholesky::factor_flops() const { return impl_->tree->flops; }
std::size_t BlockCholesky::factor_scalars() const { return impl_->tree->factor_scalars; }

}  // namespace radioslam
