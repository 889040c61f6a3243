#include "radioslam/graph/linear/front_tree.hpp"

#include <algorithm>

#include "radioslam/base/check.hpp"

namespace radioslam {
namespace {

/// Measured on fronts of 3 x 3 and 6 x 6 blocks.
constexpr FrontCost kFrontCost{.per_front = 1000, .per_entry = 6};

/// Nested dissection takes as long as about this many operations per block. Where a factorisation takes
/// fewer, a better order would not repay it.
constexpr double kDissectionFlopsPerBlock = 5e4;

EliminationTree cheapest_tree(const BlockGraph& graph, Ordering ordering) {
  switch (ordering) {
    case Ordering::kNatural:
      return elimination_tree(graph, natural_order(graph));
    case Ordering::kAmd:
      return elimination_tree(graph, minimum_degree_order(graph));
    case Ordering::kMetis:
      return elimination_tree(graph, nested_dissection_order(graph));
    case Ordering::kBest:
      break;
  }
  auto amd = elimination_tree(graph, minimum_degree_order(graph));
  const double amd_flops = factorization_flops(graph, amd);
  if (amd_flops < kDissectionFlopsPerBlock * static_cast<double>(graph.blocks())) return amd;
  auto metis = elimination_tree(graph, nested_dissection_order(graph));
  return factorization_flops(graph, metis) < amd_flops ? metis : amd;
}

EliminationTree ordered_tree(const BlockGraph& graph, const BlockCholeskyOptions& options) {
  if (options.last.empty()) return cheapest_tree(graph, options.ordering);
  const std::vector<std::uint32_t> last(options.last.begin(), options.last.end());
  for (const auto block : last) RADIOSLAM_CHECK(block < graph.blocks(), "no such block to put last");
  const auto rest = without_blocks(graph, last);
  EliminationOrder order;
  for (const auto block : cheapest_tree(rest.graph, options.ordering).order) {
    order.push_back(rest.original[block]);
  }
  order.insert(order.end(), last.begin(), last.end());
  RADIOSLAM_CHECK(order.size() == graph.blocks(), "a block is named last twice");
  return elimination_tree(graph, order);
}

void place_blocks(FrontTree& tree, const BlockGraph& graph, const EliminationTree& elimination,
                  const std::vector<Supernode>& nodes) {
  std::vector<std::size_t> scalar_of_block{0};
  for (const auto size : graph.sizes) scalar_of_block.push_back(scalar_of_block.back() + size);
  tree.place.resize(graph.blocks());
  tree.first_scalar = {0};
  for (std::uint32_t s = 0; s < nodes.size(); ++s) {
    auto& front = tree.fronts.emplace_back();
    front.parent = nodes[s].parent;
    front.pivots = nodes[s].pivot_scalars;
    front.first_scalar = tree.first_scalar.back();
    front.blocks = {tree.order.size(), tree.order.size() + nodes[s].columns.size()};
    for (const auto column : nodes[s].columns) {
      const auto block = elimination.order[column];
      tree.place[block] = static_cast<std::uint32_t>(tree.order.size());
      tree.order.push_back(block);
      tree.front_of.push_back(s);
      tree.original_scalar.push_back(scalar_of_block[block]);
      tree.first_scalar.push_back(tree.first_scalar.back() + graph.sizes[block]);
    }
  }
}

void list_front_children(FrontTree& tree) {
  std::vector<std::vector<std::uint32_t>> children(tree.fronts.size());
  for (std::uint32_t s = 0; s < tree.fronts.size(); ++s) {
    if (tree.fronts[s].parent != kNoParent) children[tree.fronts[s].parent].push_back(s);
  }
  for (std::size_t s = 0; s < tree.fronts.size(); ++s) {
    tree.fronts[s].children = {tree.children.size(), tree.children.size() + children[s].size()};
    tree.children.insert(tree.children.end(), children[s].begin(), children[s].end());
  }
}

/// The rows below a front: what its pivots touch in the matrix, and what its children pass on.
void find_rows(FrontTree& tree, const BlockGraph& graph) {
  std::vector<std::uint32_t> seen_by(tree.blocks(), kNoParent);
  for (std::uint32_t s = 0; s < tree.fronts.size(); ++s) {
    auto& front = tree.fronts[s];
    std::vector<std::uint32_t> rows;
    const auto add = [&](std::uint32_t at) {
      if (at < front.blocks.end || seen_by[at] == s) return;
      seen_by[at] = s;
      rows.push_back(at);
    };
    for (auto at = front.blocks.begin; at < front.blocks.end; ++at) {
      const auto block = tree.order[at];
      for (auto e = graph.starts[block]; e < graph.starts[block + 1]; ++e)
        add(tree.place[graph.neighbours[e]]);
    }
    for (auto c = front.children.begin; c < front.children.end; ++c) {
      const auto child_rows = tree.fronts[tree.children[c]].rows;
      for (auto k = child_rows.begin; k < child_rows.end; ++k) add(tree.row_blocks[k]);
    }
    std::sort(rows.begin(), rows.end());
    front.rows = {tree.row_blocks.size(), tree.row_blocks.size() + rows.size()};
    for (const auto at : rows) {
      tree.row_blocks.push_back(at);
      tree.row_starts.push_back(static_cast<std::uint32_t>(front.scalars()));
      front.below += tree.block_size(at);
    }
  }
}

void append_row(FrontTree& tree, Front& front, const RowRun& block, std::size_t parent_pivots) {
  if (block.parent_row < parent_pivots) front.below_in_pivots += block.length;
  if (front.runs.end > front.runs.begin && block.parent_row != parent_pivots) {
    auto& last = tree.runs.back();
    if (last.parent_row + last.length == block.parent_row) {
      last.length += block.length;
      return;
    }
  }
  tree.runs.push_back(block);
  front.runs.end = tree.runs.size();
}

void find_runs(FrontTree& tree) {
  for (auto& front : tree.fronts) {
    front.runs = {tree.runs.size(), tree.runs.size()};
    if (front.parent == kNoParent) continue;
    const auto& parent = tree.fronts[front.parent];
    for (auto k = front.rows.begin; k < front.rows.end; ++k) {
      const auto at = tree.row_blocks[k];
      append_row(tree, front,
                 {tree.row_starts[k] - static_cast<std::uint32_t>(front.pivots), *find_row(tree, parent, at),
                  static_cast<std::uint32_t>(tree.block_size(at))},
                 parent.pivots);
    }
  }
}

/// Panels one after another. Update matrices on two stacks, by the parity of the depth, so that a front's own
/// is never pushed above its children's. Covariances on a stack along the path from the root.
void assign_storage(FrontTree& tree) {
  const auto count = tree.fronts.size();
  std::vector<std::size_t> depth(count, 0);
  for (auto s = count; s-- > 0;) {
    auto& front = tree.fronts[s];
    if (front.parent != kNoParent) {
      const auto& parent = tree.fronts[front.parent];
      depth[s] = depth[front.parent] + 1;
      front.covariance = parent.covariance + parent.below * parent.below;
    }
    tree.covariance_scalars = std::max(tree.covariance_scalars, front.covariance + front.below * front.below);
  }
  std::size_t top[2] = {0, 0}, peak[2] = {0, 0};
  for (std::size_t s = 0; s < count; ++s) {
    auto& front = tree.fronts[s];
    front.panel = tree.factor_scalars;
    tree.factor_scalars += front.scalars() * front.pivots;
    const auto own = depth[s] % 2;
    front.update = top[own];
    top[own] += front.below * front.below;
    peak[own] = std::max(peak[own], top[own]);
    for (auto c = front.children.begin; c < front.children.end; ++c) {
      const auto& child = tree.fronts[tree.children[c]];
      top[1 - own] -= child.below * child.below;
    }
  }
  for (std::size_t s = 0; s < count; ++s) {
    if (depth[s] % 2 == 1) tree.fronts[s].update += peak[0];
  }
  tree.stack_scalars = peak[0] + peak[1];
}

void find_slots(FrontTree& tree, const BlockPattern& pattern) {
  std::vector<std::vector<BlockSlot>> slots(tree.fronts.size());
  const auto add = [&](std::uint32_t block, std::uint32_t row, std::uint32_t column) {
    const bool transposed = row < column;
    if (transposed) std::swap(row, column);
    const auto& front = tree.fronts[tree.front_of[column]];
    const auto destination = front.panel + *find_row(tree, front, row) +
                             (tree.first_scalar[column] - front.first_scalar) * front.scalars();
    slots[tree.front_of[column]].push_back({block, transposed, destination});
  };
  const auto n = static_cast<std::uint32_t>(pattern.blocks());
  for (std::uint32_t i = 0; i < n; ++i) add(i, tree.place[i], tree.place[i]);
  for (std::uint32_t k = 0; k < pattern.lower.size(); ++k) {
    const auto [row, column] = pattern.lower[k];
    add(n + k, tree.place[static_cast<std::size_t>(row)], tree.place[static_cast<std::size_t>(column)]);
  }
  for (std::size_t s = 0; s < tree.fronts.size(); ++s) {
    tree.fronts[s].slots = {tree.slots.size(), tree.slots.size() + slots[s].size()};
    tree.slots.insert(tree.slots.end(), slots[s].begin(), slots[s].end());
  }
}

void sum_up(FrontTree& tree) {
  for (const auto& front : tree.fronts) {
    const auto p = static_cast<double>(front.pivots);
    const auto r = static_cast<double>(front.below);
    tree.flops += p * p * p / 3 + p * p * r + p * r * r;
    tree.largest_front = std::max(tree.largest_front, front.scalars());
    tree.largest_panel = std::max(tree.largest_panel, front.scalars() * front.pivots);
  }
}

}  // namespace

std::optional<std::uint32_t> find_row(const FrontTree& tree, const Front& front, std::uint32_t at) {
  if (at < front.blocks.begin) return std::nullopt;
  if (at < front.blocks.end) {
    return static_cast<std::uint32_t>(tree.first_scalar[at] - front.first_scalar);
  }
  const auto begin = tree.row_blocks.begin();
  const auto end = begin + static_cast<std::ptrdiff_t>(front.rows.end);
  const auto found = std::lower_bound(begin + static_cast<std::ptrdiff_t>(front.rows.begin), end, at);
  if (found == end || *found != at) return std::nullopt;
  return tree.row_starts[static_cast<std::size_t>(found - begin)];
}

FrontTree front_tree(const BlockPattern& pattern, const BlockCholeskyOptions& options) {
  const auto graph = block_graph(pattern);
  const auto elimination = ordered_tree(graph, options);
  const auto nodes = join_columns(graph, elimination, kFrontCost);
  FrontTree tree;
  place_blocks(tree, graph, elimination, nodes);
  list_front_children(tree);
  find_rows(tree, graph);
  find_runs(tree);
  assign_storage(tree);
  find_slots(tree, pattern);
  sum_up(tree);
  return tree;
}

}  // namespace radioslam
