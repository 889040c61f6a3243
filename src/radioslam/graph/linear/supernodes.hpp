// Columns of the factor with (nearly) the same pattern, joined so that they are eliminated as one dense
// front. Source: Ashcraft and Grimes 1989 (relaxed supernodes); the trade of explicit zeros against the cost
// of a front is by the cost model below.
#pragma once

#include "radioslam/graph/linear/elimination_tree.hpp"

namespace radioslam {

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
