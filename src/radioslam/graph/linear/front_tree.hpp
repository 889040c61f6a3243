// Everything about a factorisation that depends on the pattern only: the fronts, where the matrix's blocks go
// in them, how an update matrix is added to the parent front, and where all numbers are stored.
//
// A front of p pivot and r further rows is a column-major panel of p + r rows and p columns (L_PP above L_RP)
// and, while the parent has not taken it, an r x r update matrix. Rows of a front are in elimination order.
#pragma once

#include "radioslam/graph/linear/block_cholesky.hpp"
#include "radioslam/graph/linear/supernodes.hpp"

namespace radioslam {

/// A place or size as Eigen takes it.
inline Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

/// `length` successive rows of a front's update matrix that are successive rows of the parent front.
/// A run is in the parent's pivots or below them, not across.
struct RowRun {
  std::uint32_t row = 0;
  std::uint32_t parent_row = 0;
  std::uint32_t length = 0;
};

/// Where a block of the matrix goes.
struct BlockSlot {
  std::uint32_t block = 0;      ///< diagonal block i, or pattern.blocks() + k for the k-th lower block
  bool transposed = false;      ///< the order of elimination is against the block's row and column
  std::size_t destination = 0;  ///< of its first entry, in the factor's storage
};

/// A half-open range of places in an array.
struct Range {
  std::size_t begin = 0, end = 0;
};

struct Front {
  std::uint32_t parent = kNoParent;
  std::size_t pivots = 0;           ///< p, scalars
  std::size_t below = 0;            ///< r, scalars
  std::size_t below_in_pivots = 0;  ///< how many of the r rows are pivots of the parent
  std::size_t first_scalar = 0;     ///< first pivot in elimination order
  std::size_t panel = 0;            ///< start of the panel in the factor's storage
  std::size_t update = 0;           ///< start of the update matrix in the stack's storage
  std::size_t covariance = 0;       ///< start of the covariance of the rows below, for the pass down the tree
  Range blocks;                     ///< pivot blocks, by place in the order
  Range rows;                       ///< in FrontTree::row_blocks: blocks below
  Range runs;                       ///< in FrontTree::runs
  Range slots;                      ///< in FrontTree::slots
  Range children;                   ///< in FrontTree::children

  std::size_t scalars() const { return pivots + below; }
};

struct FrontTree {
  EliminationOrder order;                    ///< block at each place
  std::vector<std::uint32_t> place;          ///< place of each block
  std::vector<std::size_t> first_scalar;     ///< of the block at each place, in elimination order; one more
  std::vector<std::size_t> original_scalar;  ///< of the block at each place, in the matrix
  std::vector<std::uint32_t> front_of;       ///< front that eliminates the block at each place
  std::vector<Front> fronts;                 ///< children before parents
  std::vector<std::uint32_t> row_blocks;     ///< places, ascending in each front
  std::vector<std::uint32_t> row_starts;     ///< first scalar row in the front of each row block
  std::vector<RowRun> runs;
  std::vector<BlockSlot> slots;
  std::vector<std::uint32_t> children;
  std::size_t factor_scalars = 0;      ///< all panels
  std::size_t stack_scalars = 0;       ///< update matrices alive at once
  std::size_t covariance_scalars = 0;  ///< covariances of rows below alive at once
  std::size_t largest_front = 0;       ///< scalars, pivots and below
  std::size_t largest_panel = 0;       ///< p (p + r)
  double flops = 0;                    ///< of a factorisation, explicit zeros included

  std::size_t blocks() const { return order.size(); }
  std::size_t scalars() const { return first_scalar.back(); }
  std::size_t block_size(std::size_t at) const { return first_scalar[at + 1] - first_scalar[at]; }
};

/// Calls body(first row in the front, first scalar, rows, front that eliminates them) for the blocks below a
/// front's pivots.
template <class Body>
void for_each_block_below(const FrontTree& tree, const Front& front, const Body& body) {
  for (auto k = front.rows.begin; k < front.rows.end; ++k) {
    const auto at = tree.row_blocks[k];
    body(std::size_t{tree.row_starts[k]}, tree.first_scalar[at], tree.block_size(at), tree.front_of[at]);
  }
}

/// First scalar row, in the front, of the block at a place; nothing when the front does not have it.
std::optional<std::uint32_t> find_row(const FrontTree& tree, const Front& front, std::uint32_t at);

FrontTree front_tree(const BlockPattern& pattern, const BlockCholeskyOptions& options);

}  // namespace radioslam
