#include "radioslam/graph/linear/partitioned_inverse.hpp"

#include <algorithm>

#include "radioslam/base/check.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/graph/linear/front_solve.hpp"

namespace radioslam {
namespace {

/// Rows that are solved for at once.
constexpr std::size_t kRows = 48;
/// Scalars of a part: at least so many, and about a fraction of all.
constexpr std::size_t kMinPartScalars = 256, kWantedParts = 16;
/// 128 and 256 MiB.
constexpr std::size_t kMaxSeparatorScalars = 4096, kMaxMapScalars = std::size_t{1} << 25;

/// Scalars of every front and all below it.
std::vector<std::size_t> subtree_scalars(const FrontTree& tree) {
  std::vector<std::size_t> scalars(tree.fronts.size(), 0);
  for (std::size_t f = 0; f < tree.fronts.size(); ++f) {
    scalars[f] += tree.fronts[f].pivots;
    if (tree.fronts[f].parent != kNoParent) scalars[tree.fronts[f].parent] += scalars[f];
  }
  return scalars;
}

/// What parts of a size take.
struct PartCosts {
  std::size_t separator_scalars = 0;
  std::size_t map_scalars = 0;  ///< of the maps from the parts to their boundaries
};

PartCosts part_costs(const FrontTree& tree, const std::vector<std::size_t>& scalars,
                     std::size_t part_scalars) {
  PartCosts costs;
  std::vector<std::size_t> boundary(tree.fronts.size());  // of the part that a front belongs to
  for (std::size_t f = tree.fronts.size(); f-- > 0;) {
    const Front& front = tree.fronts[f];
    const bool is_separator = front.parent == kNoParent || scalars[f] > part_scalars;
    boundary[f] = is_separator ? front.scalars() : boundary[front.parent];
    costs.map_scalars += front.pivots * boundary[f];
    if (is_separator) costs.separator_scalars += front.pivots;
  }
  return costs;
}

/// About a fraction of all scalars; more where separators or maps would take too much memory.
std::size_t wanted_part_scalars(const FrontTree& tree) {
  const auto scalars = subtree_scalars(tree);
  std::size_t cheapest = tree.scalars(), least = ~std::size_t{0};
  for (std::size_t size = std::max(kMinPartScalars, tree.scalars() / kWantedParts);; size *= 2) {
    const PartCosts costs = part_costs(tree, scalars, size);
    if (costs.separator_scalars <= kMaxSeparatorScalars && costs.map_scalars <= kMaxMapScalars) return size;
    const std::size_t all = costs.separator_scalars * costs.separator_scalars + costs.map_scalars;
    if (all < least) least = all, cheapest = size;
    if (size >= tree.scalars()) return cheapest;
  }
}

}  // namespace

PartitionedInverse::PartitionedInverse(const FrontTree& tree, const NumberStore& factor,
                                       std::size_t part_scalars)
    : tree_(tree), factor_(factor) {
  find_parts(part_scalars > 0 ? part_scalars : wanted_part_scalars(tree));
  number_scalars();
  find_boundaries();
  find_maps();
  invert_separators();
}

void PartitionedInverse::find_parts(std::size_t part_scalars) {
  const auto scalars = subtree_scalars(tree_);
  is_separator_.resize(tree_.fronts.size());
  part_.resize(tree_.fronts.size());
  for (auto f = static_cast<std::uint32_t>(tree_.fronts.size()); f-- > 0;) {
    const Front& front = tree_.fronts[f];
    is_separator_[f] = front.parent == kNoParent || scalars[f] > part_scalars;
    if (is_separator_[f]) {
      part_[f] = static_cast<std::uint32_t>(parts_.size());
      parts_.emplace_back().pivots = front.pivots;
      separator_fronts_.push_back(f);
    } else {
      part_[f] = part_[front.parent];
      parts_[part_[f]].fronts.push_back(f);
    }
  }
  std::reverse(separator_fronts_.begin(), separator_fronts_.end());
  for (Part& part : parts_) std::reverse(part.fronts.begin(), part.fronts.end());
}

void PartitionedInverse::number_scalars() {
  column_.resize(tree_.scalars());
  separator_.assign(tree_.scalars(), kNone);
  for (std::uint32_t f = 0; f < tree_.fronts.size(); ++f) {
    const Front& front = tree_.fronts[f];
    for (std::size_t k = 0; k < front.pivots && !is_separator_[f]; ++k)
      column_[front.first_scalar + k] = static_cast<std::uint32_t>(parts_[part_[f]].scalars++);
  }
  std::uint32_t separators = 0;
  for (const std::uint32_t f : separator_fronts_) {
    const Front& front = tree_.fronts[f];
    for (std::size_t k = 0; k < front.pivots; ++k) {
      column_[front.first_scalar + k] = static_cast<std::uint32_t>(parts_[part_[f]].scalars + k);
      separator_[front.first_scalar + k] = separators++;
    }
  }
  separators_.resize(separators, separators);
}

/// Everything above a separator is one, too.
void PartitionedInverse::find_boundaries() {
  for (const std::uint32_t f : separator_fronts_) {
    const Front& front = tree_.fronts[f];
    auto& boundary = parts_[part_[f]].boundary;
    for (std::size_t k = 0; k < front.pivots; ++k) boundary.push_back(separator_[front.first_scalar + k]);
    for_each_block_below(tree_, front, [&](std::size_t, std::size_t scalar, std::size_t count, auto) {
      for (std::size_t k = 0; k < count; ++k) boundary.push_back(separator_[scalar + k]);
    });
  }
}

void PartitionedInverse::find_maps() {
  parallel_for(parts_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) find_map(parts_[p]);
  });
}

/// Back substitution from unit values on the boundary.
void PartitionedInverse::find_map(Part& part) const {
  const Eigen::Index r = index(part.boundary.size()), n = index(part.scalars);
  std::vector<std::uint32_t> on_boundary(static_cast<std::size_t>(separators_.rows()), kNone);
  for (std::size_t k = 0; k < part.boundary.size(); ++k)
    on_boundary[part.boundary[k]] = static_cast<std::uint32_t>(part.scalars + k);
  const auto column = [&](std::size_t scalar) -> std::size_t {
    return separator_[scalar] == kNone ? column_[scalar] : on_boundary[separator_[scalar]];
  };
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(r, n + r);
  x.rightCols(r).setIdentity();
  FrontSolver solver(tree_, factor_);
  for (auto f = part.fronts.rbegin(); f != part.fronts.rend(); ++f)
    solver.backward(tree_.fronts[*f], column, x);
  part.by_boundary = x.leftCols(n + index(part.pivots));
}

void PartitionedInverse::invert_separators() {
  const auto count = static_cast<std::size_t>(separators_.rows());
  parallel_for((count + kRows - 1) / kRows, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t piece = begin; piece < end; ++piece) {
      const std::size_t first = piece * kRows, last = std::min(count, first + kRows);
      separators_.middleRows(index(first), index(last - first)) = separator_rows(first, last);
    }
  });
}

Eigen::MatrixXd PartitionedInverse::separator_rows(std::size_t first, std::size_t last) const {
  const auto column = [&](std::size_t scalar) -> std::size_t { return separator_[scalar]; };
  FrontSolver solver(tree_, factor_);
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(index(last - first), separators_.cols());
  const auto to_the_root = [](std::uint32_t) { return true; };
  for (const std::uint32_t f : separator_fronts_) {
    const Front& front = tree_.fronts[f];
    for (std::size_t k = front.first_scalar; k < front.first_scalar + front.pivots; ++k)
      if (separator_[k] >= first && separator_[k] < last)
        solver.forward_unit(k, f, to_the_root, column, x.row(index(separator_[k] - first)));
  }
  for (auto f = separator_fronts_.rbegin(); f != separator_fronts_.rend(); ++f)
    solver.backward(tree_.fronts[*f], column, x);
  return x;
}

Eigen::MatrixXd PartitionedInverse::local_rows(const std::vector<std::size_t>& blocks) const {
  const Part& part = parts_[part_of(blocks.front())];
  // One column of zeros past the part's own stands for all of the boundary.
  const auto column = [&](std::size_t scalar) -> std::size_t {
    return separator_[scalar] == kNone ? column_[scalar] : part.scalars;
  };
  Eigen::Index rows = 0;
  for (const std::size_t block : blocks) {
    RADIOSLAM_CHECK(&parts_[part_of(block)] == &part && !is_separator(block), "blocks are inside one part");
    rows += place_of(block).size;
  }
  const auto is_inside = [&](std::uint32_t f) { return !is_separator_[f]; };
  FrontSolver solver(tree_, factor_);
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(rows, index(part.scalars + 1));
  Eigen::Index row = 0;
  for (const std::size_t block : blocks) {
    const std::size_t at = tree_.place[block];
    for (std::size_t scalar = tree_.first_scalar[at]; scalar < tree_.first_scalar[at + 1]; ++scalar)
      solver.forward_unit(scalar, tree_.front_of[at], is_inside, column, x.row(row++));
  }
  for (auto f = part.fronts.rbegin(); f != part.fronts.rend(); ++f)
    solver.backward(tree_.fronts[*f], column, x);
  return x.leftCols(index(part.scalars));
}

PartitionedInverse::Place PartitionedInverse::place_of(std::size_t block) const {
  RADIOSLAM_CHECK(block < tree_.blocks(), "no such block");
  const std::size_t at = tree_.place[block];
  return {part_[tree_.front_of[at]], index(column_[tree_.first_scalar[at]]), index(tree_.block_size(at))};
}

std::size_t PartitionedInverse::part_of(std::size_t block) const { return place_of(block).part; }

bool PartitionedInverse::is_separator(std::size_t block) const {
  return is_separator_[tree_.front_of[tree_.place[block]]];
}

}  // namespace radioslam
