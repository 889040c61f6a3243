// Columns of the factor with (nearly) the same pattern, joined so that they are eliminated as one dense
// front. Source: Ashcraft and Grimes 1989 (relaxed supernodes); the trade of explicit zeros against the cost
// of a front is by the cost model below.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "radioslam/graph/linear/block_matrix.hpp"

namespace radioslam {

// The order in which the blocks of a sparse symmetric matrix are eliminated.
// Sources: Amestoy, Davis and Duff 1996 (approximate minimum degree, SuiteSparse); Karypis and
// Kumar 1998 (nested dissection, METIS). Both work on the graph of blocks, not of scalars.
// SuiteSparse's AMD rather than Eigen's: on pose graphs its orders need 3 to 30 % fewer operations.

/// order[k] is the block that is eliminated k-th.
using EliminationOrder = std::vector<std::uint32_t>;

/// The neighbours of every block, each edge listed at both ends, in ascending order.
struct BlockGraph {
  std::vector<std::uint32_t> starts{0};  ///< blocks() + 1
  std::vector<std::uint32_t> neighbours;
  std::vector<std::uint32_t> sizes;  ///< scalar rows of a block

  std::size_t blocks() const { return sizes.size(); }
};

BlockGraph block_graph(const BlockPattern& pattern);

/// A graph without some of its blocks, and what its blocks were called.
struct BlockSubgraph {
  BlockGraph graph;
  std::vector<std::uint32_t> original;
};
BlockSubgraph without_blocks(const BlockGraph& graph, const std::vector<std::uint32_t>& removed);

EliminationOrder natural_order(const BlockGraph& graph);
EliminationOrder minimum_degree_order(const BlockGraph& graph);
EliminationOrder nested_dissection_order(const BlockGraph& graph);

// The elimination tree of a sparse symmetric matrix under an order, with the fill it implies.
// parent(k) is the first block after k that eliminating k touches. Source: Liu 1990.

inline constexpr std::uint32_t kNoParent = ~std::uint32_t{0};

/// All arrays are by place in `order`, which is a postorder: a subtree is a range that ends with its root.
struct EliminationTree {
  EliminationOrder order;
  std::vector<std::uint32_t> parent;
  std::vector<std::uint32_t> below_blocks;  ///< blocks of the factor's column below the diagonal
  std::vector<std::size_t> below_scalars;   ///< their scalar rows
};

/// Takes an order and returns an equivalent one (same fill) with its tree. Cost: blocks of the factor.
EliminationTree elimination_tree(const BlockGraph& graph, const EliminationOrder& order);

/// Multiplications and additions of a factorisation.
double factorization_flops(const BlockGraph& graph, const EliminationTree& tree);

/// A postorder of a forest given by parents: place k holds the node that comes k-th. Siblings come by
/// descending priority; at equal or no priority by number.
std::vector<std::uint32_t> postorder(const std::vector<std::uint32_t>& parent,
                                     const std::vector<double>& priority = {});

/// Cost of eliminating a front of p pivots with r rows below, in floating-point operations:
/// p^3/3 + p^2 r + p r^2 + per_front + per_entry (p + r)^2.
struct FrontCost {
  double per_front = 0;
  double per_entry = 0;
};

struct Supernode {
  std::vector<std::uint32_t> columns;  ///< places in the tree's order, ascending
  std::uint32_t parent = kNoParent;
  std::size_t pivot_scalars = 0;
  std::size_t below_scalars = 0;
};

/// In postorder, siblings so that the update matrices waiting to be added take little memory (Liu 1986).
std::vector<Supernode> join_columns(const BlockGraph& graph, const EliminationTree& tree,
                                    const FrontCost& cost);

}  // namespace radioslam
