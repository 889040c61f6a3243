// Which block of the normal equations belongs to which variable, and where a factor adds to them.
// Order of the blocks: poses, points, drifts, range biases, without held poses and variables that no factor
// touches.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "radioslam/graph/factor_lists.hpp"
#include "radioslam/graph/linear/block_matrix.hpp"

namespace radioslam {

/// The block of each variable; -1 for those left out.
struct VariableBlocks {
  std::vector<std::int32_t> poses, points, drifts, biases;

  std::int32_t of(const Variable& v) const;
};

template <class Pose>
VariableBlocks number_blocks(const PoseGraph<Pose>& graph, const std::vector<bool>& held);

/// Every block that some factor adds to.
template <class Pose>
BlockPattern block_pattern(const PoseGraph<Pose>& graph, const VariableBlocks& blocks);

/// Sorts the places below the diagonal by column and drops repeated ones, as BlockPattern wants them.
void sort_lower(BlockPattern& pattern);

/// Where a factor of K variables adds; -1 for what is left out.
template <std::size_t K>
struct FactorSlots {
  std::array<std::int32_t, K> blocks;
  std::array<std::int32_t, K*(K - 1) / 2> lower;  ///< of the pairs (0, 1), (0, 2), (1, 2)
};

/// Calls body(pair number, a, b) for the pairs a < b of K variables, in the order of FactorSlots::lower.
template <std::size_t K, class Body>
void for_each_pair(Body&& body) {
  std::size_t pair = 0;
  for (std::size_t a = 0; a < K; ++a)
    for (std::size_t b = a + 1; b < K; ++b) body(pair++, a, b);
}

/// The blocks of a factor's variables. A factor between a pose and itself does not depend on it.
template <std::size_t K>
std::array<std::int32_t, K> block_indices(const VariableBlocks& blocks,
                                          const std::array<Variable, K>& variables) {
  std::array<std::int32_t, K> indices;
  for (std::size_t k = 0; k < K; ++k) indices[k] = blocks.of(variables[k]);
  if constexpr (K >= 2)
    if (variables[0] == variables[1]) indices[0] = indices[1] = -1;
  return indices;
}

template <std::size_t K>
FactorSlots<K> factor_slots(const SymmetricBlockMatrix& matrix, const VariableBlocks& blocks,
                            const std::array<Variable, K>& variables) {
  FactorSlots<K> slots{block_indices(blocks, variables), {}};
  for_each_pair<K>([&](std::size_t pair, std::size_t a, std::size_t b) {
    const std::int32_t low = std::min(slots.blocks[a], slots.blocks[b]);
    const std::int32_t high = std::max(slots.blocks[a], slots.blocks[b]);
    slots.lower[pair] = low < 0 ? -1 : static_cast<std::int32_t>(matrix.find_lower(high, low));
  });
  return slots;
}

}  // namespace radioslam
