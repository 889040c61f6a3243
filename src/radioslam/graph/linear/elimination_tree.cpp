#include "radioslam/graph/linear/elimination_tree.hpp"

#include <algorithm>
#include <numeric>

namespace radioslam {
namespace {

std::vector<std::uint32_t> inverse(const std::vector<std::uint32_t>& order) {
  std::vector<std::uint32_t> position(order.size());
  for (std::uint32_t k = 0; k < order.size(); ++k) position[order[k]] = k;
  return position;
}

/// Liu's algorithm with path compression.
std::vector<std::uint32_t> find_parents(const BlockGraph& graph, const EliminationOrder& order,
                                        const std::vector<std::uint32_t>& position) {
  std::vector<std::uint32_t> parent(order.size(), kNoParent), ancestor(order.size(), kNoParent);
  for (std::uint32_t k = 0; k < order.size(); ++k) {
    for (auto e = graph.starts[order[k]]; e < graph.starts[order[k] + 1]; ++e) {
      auto i = position[graph.neighbours[e]];
      while (i < k) {
        const auto next = ancestor[i];
        ancestor[i] = k;
        if (next == kNoParent) parent[i] = k;
        i = std::min(next, k);
      }
    }
  }
  return parent;
}

/// Row k of the factor is the set of tree paths from k's earlier neighbours up to k.
void count_fill(const BlockGraph& graph, EliminationTree& tree) {
  const auto position = inverse(tree.order);
  const auto n = static_cast<std::uint32_t>(tree.order.size());
  tree.below_blocks.assign(n, 0);
  tree.below_scalars.assign(n, 0);
  std::vector<std::uint32_t> reached_by(n, kNoParent);
  for (std::uint32_t k = 0; k < n; ++k) {
    const auto block = tree.order[k];
    reached_by[k] = k;
    for (auto e = graph.starts[block]; e < graph.starts[block + 1]; ++e) {
      auto i = position[graph.neighbours[e]];
      for (; i < k && reached_by[i] != k; i = tree.parent[i]) {
        reached_by[i] = k;
        ++tree.below_blocks[i];
        tree.below_scalars[i] += graph.sizes[block];
      }
    }
  }
}

/// Children of every node in the order they are to be visited, as first child and next sibling; the roots
/// are the children of an extra node at the end.
struct Children {
  std::vector<std::uint32_t> first, next;
};

Children list_children(const std::vector<std::uint32_t>& parent, const std::vector<double>& priority) {
  const auto n = static_cast<std::uint32_t>(parent.size());
  std::vector<std::uint32_t> nodes(n);
  std::iota(nodes.begin(), nodes.end(), 0U);
  if (!priority.empty()) {
    std::stable_sort(nodes.begin(), nodes.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return priority[a] > priority[b]; });
  }
  Children children{std::vector<std::uint32_t>(n + 1, kNoParent), std::vector<std::uint32_t>(n, kNoParent)};
  for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) {
    auto& first = children.first[parent[*node] == kNoParent ? n : parent[*node]];
    children.next[*node] = first;
    first = *node;
  }
  return children;
}

}  // namespace

std::vector<std::uint32_t> postorder(const std::vector<std::uint32_t>& parent,
                                     const std::vector<double>& priority) {
  const auto n = static_cast<std::uint32_t>(parent.size());
  auto [first, next] = list_children(parent, priority);
  std::vector<std::uint32_t> order, path{n};
  order.reserve(n);
  while (!path.empty()) {
    const auto node = path.back();
    const auto child = first[node];
    if (child != kNoParent) {
      first[node] = next[child];
      path.push_back(child);
    } else {
      path.pop_back();
      if (node != n) order.push_back(node);
    }
  }
  return order;
}

EliminationTree elimination_tree(const BlockGraph& graph, const EliminationOrder& order) {
  const auto parent = find_parents(graph, order, inverse(order));
  const auto post = postorder(parent);
  const auto place = inverse(post);
  EliminationTree tree;
  tree.order.resize(order.size());
  tree.parent.resize(order.size());
  for (std::size_t k = 0; k < post.size(); ++k) {
    tree.order[k] = order[post[k]];
    tree.parent[k] = parent[post[k]] == kNoParent ? kNoParent : place[parent[post[k]]];
  }
  count_fill(graph, tree);
  return tree;
}

double factorization_flops(const BlockGraph& graph, const EliminationTree& tree) {
  double flops = 0;
  for (std::size_t k = 0; k < tree.order.size(); ++k) {
    const auto p = static_cast<double>(graph.sizes[tree.order[k]]);
    const auto r = static_cast<double>(tree.below_scalars[k]);
    flops += p * p * p / 3 + p * p * r + p * r * r;
  }
  return flops;
}

}  // namespace radioslam
