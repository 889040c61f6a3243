// The elimination tree of a sparse symmetric matrix under an order, with the fill it implies.
// parent(k) is the first block after k that eliminating k touches. Source: Liu 1990.
#pragma once

#include "radioslam/graph/linear/ordering.hpp"

namespace radioslam {

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

}  // namespace radioslam
