#include "radioslam/graph/linear/supernodes.hpp"

#include <amd.h>
#include <metis.h>

#include <algorithm>
#include <mutex>
#include <numeric>

#include "radioslam/base/check.hpp"

namespace radioslam {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

BlockGraph graph_of_edges(std::vector<std::uint32_t> sizes, const std::vector<Edge>& edges) {
  BlockGraph graph;
  graph.starts.assign(sizes.size() + 1, 0);
  graph.sizes = std::move(sizes);
  for (const auto& [a, b] : edges) {
    ++graph.starts[a + 1];
    ++graph.starts[b + 1];
  }
  std::partial_sum(graph.starts.begin(), graph.starts.end(), graph.starts.begin());
  graph.neighbours.resize(2 * edges.size());
  auto next = graph.starts;
  for (const auto& [a, b] : edges) {
    graph.neighbours[next[a]++] = b;
    graph.neighbours[next[b]++] = a;
  }
  for (std::size_t i = 0; i < graph.blocks(); ++i) {
    std::sort(graph.neighbours.begin() + graph.starts[i], graph.neighbours.begin() + graph.starts[i + 1]);
  }
  return graph;
}

std::vector<idx_t> metis_integers(const std::vector<std::uint32_t>& values) {
  return {values.begin(), values.end()};
}

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

using ChildLists = std::vector<std::vector<std::uint32_t>>;

double work(const FrontCost& cost, std::size_t pivots, std::size_t below) {
  const auto p = static_cast<double>(pivots);
  const auto r = static_cast<double>(below);
  return p * p * p / 3 + p * p * r + p * r * r + cost.per_front + cost.per_entry * (p + r) * (p + r);
}

/// Chains of columns whose patterns differ by the pivot only.
std::vector<Supernode> fundamental_supernodes(const BlockGraph& graph, const EliminationTree& tree) {
  std::vector<Supernode> nodes;
  std::vector<std::uint32_t> node_of(tree.order.size());
  for (std::uint32_t k = 0; k < tree.order.size(); ++k) {
    const bool continues =
        k > 0 && tree.parent[k - 1] == k && tree.below_blocks[k - 1] == tree.below_blocks[k] + 1;
    if (!continues) nodes.emplace_back();
    node_of[k] = static_cast<std::uint32_t>(nodes.size() - 1);
    nodes.back().columns.push_back(k);
    nodes.back().pivot_scalars += graph.sizes[tree.order[k]];
    nodes.back().below_scalars = tree.below_scalars[k];
  }
  for (auto& node : nodes) {
    const auto parent = tree.parent[node.columns.back()];
    node.parent = parent == kNoParent ? kNoParent : node_of[parent];
  }
  return nodes;
}

void absorb(Supernode& node, Supernode& child) {
  node.columns.insert(node.columns.end(), child.columns.begin(), child.columns.end());
  node.pivot_scalars += child.pivot_scalars;
  child.columns.clear();
}

/// Joins a front with those of its children that are cheaper to eliminate in it than by themselves.
void amalgamate(std::vector<Supernode>& nodes, const FrontCost& cost) {
  ChildLists children(nodes.size());
  for (std::uint32_t s = 0; s < nodes.size(); ++s) {
    auto& node = nodes[s];
    auto candidates = std::move(children[s]);
    std::vector<std::uint32_t> kept;
    while (!candidates.empty()) {
      const auto c = candidates.back();
      candidates.pop_back();
      auto& child = nodes[c];
      const double apart = work(cost, node.pivot_scalars, node.below_scalars) +
                           work(cost, child.pivot_scalars, child.below_scalars);
      if (work(cost, node.pivot_scalars + child.pivot_scalars, node.below_scalars) > apart) {
        kept.push_back(c);
        continue;
      }
      absorb(node, child);
      for (const auto grandchild : children[c]) nodes[grandchild].parent = s;
      candidates.insert(candidates.end(), children[c].begin(), children[c].end());
    }
    std::sort(node.columns.begin(), node.columns.end());
    std::sort(kept.begin(), kept.end());
    children[s] = std::move(kept);
    if (node.parent != kNoParent) children[node.parent].push_back(s);
  }
}

/// Which sibling first: the one whose subtree needs most beyond the update matrix it leaves behind.
std::vector<double> stack_priority(const std::vector<Supernode>& nodes) {
  struct Need {
    double peak = 0, update = 0;
  };
  std::vector<std::vector<Need>> children(nodes.size());
  std::vector<double> priority(nodes.size(), 0);
  for (std::size_t s = 0; s < nodes.size(); ++s) {
    std::stable_sort(children[s].begin(), children[s].end(),
                     [](const Need& a, const Need& b) { return a.peak - a.update > b.peak - b.update; });
    const auto r = static_cast<double>(nodes[s].below_scalars);
    Need need{0, r * r};
    double waiting = 0;
    for (const auto& child : children[s]) {
      need.peak = std::max(need.peak, waiting + child.peak);
      waiting += child.update;
    }
    need.peak = std::max(need.peak, waiting + need.update);
    priority[s] = need.peak - need.update;
    if (nodes[s].parent != kNoParent) children[nodes[s].parent].push_back(need);
  }
  return priority;
}

std::vector<Supernode> without_absorbed(std::vector<Supernode> nodes) {
  std::vector<std::uint32_t> name(nodes.size());
  std::vector<Supernode> rest;
  for (std::size_t s = 0; s < nodes.size(); ++s) {
    name[s] = static_cast<std::uint32_t>(rest.size());
    if (!nodes[s].columns.empty()) rest.push_back(std::move(nodes[s]));
  }
  for (auto& node : rest) {
    if (node.parent != kNoParent) node.parent = name[node.parent];
  }
  return rest;
}

std::vector<Supernode> in_order(std::vector<Supernode> nodes, const std::vector<std::uint32_t>& order) {
  std::vector<std::uint32_t> place(nodes.size());
  for (std::uint32_t k = 0; k < order.size(); ++k) place[order[k]] = k;
  std::vector<Supernode> ordered;
  ordered.reserve(nodes.size());
  for (const auto s : order) {
    ordered.push_back(std::move(nodes[s]));
    auto& parent = ordered.back().parent;
    if (parent != kNoParent) parent = place[parent];
  }
  return ordered;
}

std::vector<std::uint32_t> parents(const std::vector<Supernode>& nodes) {
  std::vector<std::uint32_t> result;
  for (const auto& node : nodes) result.push_back(node.parent);
  return result;
}

}  // namespace

BlockGraph block_graph(const BlockPattern& pattern) {
  std::vector<Edge> edges;
  edges.reserve(pattern.lower.size());
  for (const auto& place : pattern.lower) {
    edges.emplace_back(static_cast<std::uint32_t>(place.row), static_cast<std::uint32_t>(place.column));
  }
  return graph_of_edges({pattern.sizes.begin(), pattern.sizes.end()}, edges);
}

BlockSubgraph without_blocks(const BlockGraph& graph, const std::vector<std::uint32_t>& removed) {
  constexpr auto kRemoved = ~std::uint32_t{0};
  std::vector<std::uint32_t> name(graph.blocks(), 0);
  for (const auto block : removed) name[block] = kRemoved;
  BlockSubgraph rest;
  std::vector<std::uint32_t> sizes;
  for (std::uint32_t i = 0; i < graph.blocks(); ++i) {
    if (name[i] == kRemoved) continue;
    name[i] = static_cast<std::uint32_t>(rest.original.size());
    rest.original.push_back(i);
    sizes.push_back(graph.sizes[i]);
  }
  std::vector<Edge> edges;
  for (const auto i : rest.original) {
    for (auto e = graph.starts[i]; e < graph.starts[i + 1]; ++e) {
      const auto j = graph.neighbours[e];
      if (j < i && name[j] != kRemoved) edges.emplace_back(name[i], name[j]);
    }
  }
  rest.graph = graph_of_edges(std::move(sizes), edges);
  return rest;
}

EliminationOrder natural_order(const BlockGraph& graph) {
  EliminationOrder order(graph.blocks());
  std::iota(order.begin(), order.end(), 0U);
  return order;
}

EliminationOrder minimum_degree_order(const BlockGraph& graph) {
  if (graph.neighbours.empty()) return natural_order(graph);
  const std::vector<int> starts(graph.starts.begin(), graph.starts.end());
  const std::vector<int> neighbours(graph.neighbours.begin(), graph.neighbours.end());
  std::vector<int> order(graph.blocks());
  const int status = amd_order(static_cast<int>(graph.blocks()), starts.data(), neighbours.data(),
                               order.data(), nullptr, nullptr);
  RADIOSLAM_CHECK(status == AMD_OK, "AMD refused a valid graph");
  return {order.begin(), order.end()};
}

EliminationOrder nested_dissection_order(const BlockGraph& graph) {
  if (graph.neighbours.empty()) return natural_order(graph);
  auto blocks = static_cast<idx_t>(graph.blocks());
  auto starts = metis_integers(graph.starts);
  auto neighbours = metis_integers(graph.neighbours);
  auto sizes = metis_integers(graph.sizes);
  std::vector<idx_t> order(graph.blocks()), position(graph.blocks());
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  static std::mutex one_at_a_time;  // METIS draws from the C library's rand(), which the whole process shares
  const std::lock_guard lock(one_at_a_time);
  const int status = METIS_NodeND(&blocks, starts.data(), neighbours.data(), sizes.data(), options,
                                  order.data(), position.data());
  RADIOSLAM_CHECK(status == METIS_OK, "METIS refused a valid graph");
  return {order.begin(), order.end()};
}

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

std::vector<Supernode> join_columns(const BlockGraph& graph, const EliminationTree& tree,
                                    const FrontCost& cost) {
  auto nodes = fundamental_supernodes(graph, tree);
  amalgamate(nodes, cost);
  nodes = without_absorbed(std::move(nodes));
  const auto order = postorder(parents(nodes), stack_priority(nodes));
  return in_order(std::move(nodes), order);
}

}  // namespace radioslam
