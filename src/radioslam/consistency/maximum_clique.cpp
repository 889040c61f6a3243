#include "radioslam/consistency/maximum_clique.hpp"

#include <algorithm>
#include <utility>

namespace radioslam {
namespace {

/// Vertices sorted by degree, in bins, so that one can lose a neighbour in O(1) (Batagelj & Zaversnik 2003).
class DegreeBins {
 public:
  explicit DegreeBins(const UndirectedGraph& graph)
      : degrees_(graph.size()), order_(graph.size()), places_(graph.size()), bin_starts_(graph.size() + 1) {
    for (std::size_t v = 0; v < graph.size(); ++v) ++bin_starts_[degrees_[v] = graph.degree(v)];
    std::size_t start = 0;
    for (std::size_t& bin : bin_starts_) start += std::exchange(bin, start);
    for (std::size_t v = 0; v < graph.size(); ++v) order_[places_[v] = bin_starts_[degrees_[v]]++] = v;
    for (std::size_t d = graph.size(); d > 0; --d) bin_starts_[d] = bin_starts_[d - 1];
    bin_starts_[0] = 0;
  }

  std::size_t at(std::size_t place) const { return order_[place]; }
  std::size_t degree(std::size_t v) const { return degrees_[v]; }
  const std::vector<std::size_t>& order() const { return order_; }

  /// Moves `v` to the front of its bin and the bin's start past it.
  void lose_neighbour(std::size_t v) {
    const std::size_t place = places_[v], front = bin_starts_[degrees_[v]]++;
    const std::size_t other = order_[front];
    std::swap(order_[place], order_[front]);
    places_[other] = place, places_[v] = front;
    --degrees_[v];
  }

 private:
  std::vector<std::size_t> degrees_, order_, places_, bin_starts_;
};

/// The candidate with most neighbours among the candidates, the lowest number of equal ones.
std::size_t best_connected(const UndirectedGraph& graph, std::span<const BitWord> candidates) {
  std::size_t best = graph.size(), most = 0;
  for_each_bit(candidates, [&](std::size_t v) {
    const std::size_t common = count_common_bits(graph.neighbours(v), candidates);
    if (best == graph.size() || common > most) best = v, most = common;
  });
  return best;
}

std::vector<std::size_t> clique_from(const UndirectedGraph& graph, std::size_t start) {
  std::vector<std::size_t> clique{start};
  const auto row = graph.neighbours(start);
  std::vector<BitWord> candidates(row.begin(), row.end());
  while (true) {
    const std::size_t v = best_connected(graph, candidates);
    if (v == graph.size()) return clique;
    clique.push_back(v);
    for (std::size_t w = 0; w < candidates.size(); ++w) candidates[w] &= graph.neighbours(v)[w];
  }
}

/// Counts branches up to a limit, over all searches of one call.
struct Budget {
  std::uint64_t spent = 0;
  std::uint64_t limit = 0;
  bool exhausted() const { return spent >= limit; }
};

/// Takes vertices that are no neighbours of one another out of the uncoloured ones, from the lowest on, and
/// calls visit(v) for each. `free` is room to work in.
template <class Visit>
void take_class(const UndirectedGraph& graph, std::vector<BitWord>& uncoloured, std::vector<BitWord>& free,
                Visit&& visit) {
  free = uncoloured;
  for (std::size_t w = 0; w < free.size(); ++w) {
    while (free[w] != 0) {
      const std::size_t v = w * kBitsPerWord + static_cast<std::size_t>(std::countr_zero(free[w]));
      const auto neighbours = graph.neighbours(v);
      free[w] &= free[w] - 1;
      for (std::size_t u = w; u < free.size(); ++u) free[u] &= ~neighbours[u];
      clear_bit(uncoloured, v);
      visit(v);
    }
  }
}

/// Whether a greedy colouring of these vertices needs at most `most` colours: then no clique among them is
/// larger than that.
bool colours_suffice(const UndirectedGraph& graph, std::vector<BitWord> vertices, std::size_t most) {
  std::vector<BitWord> free;
  for (std::size_t colours = 0; colours < most; ++colours)
    take_class(graph, vertices, free, [](std::size_t) {});
  return count_bits(vertices) == 0;
}

/// Looks in one graph for a clique of more than a given number of vertices.
class CliqueSearch {
 public:
  CliqueSearch(const UndirectedGraph& graph, Budget& budget) : graph_(&graph), budget_(&budget) {}

  /// The largest clique with more than `bar` vertices, or none.
  std::vector<std::size_t> larger_than(std::size_t bar) {
    bar_ = bar;
    std::vector<BitWord> all(graph_->words());
    for (std::size_t v = 0; v < graph_->size(); ++v) set_bit(all, v);
    level(0).candidates = std::move(all);
    expand(0);
    return best_;
  }

 private:
  /// A vertex to branch on and the number of colours that it and those before it need.
  struct Branch {
    std::size_t vertex, colours;
  };
  struct Level {
    std::vector<BitWord> candidates;
    std::vector<Branch> branches;
  };

  Level& level(std::size_t depth) {
    while (levels_.size() <= depth) levels_.push_back({std::vector<BitWord>(graph_->words()), {}});
    return levels_[depth];
  }

  /// Colours the candidates greedily, class by class. Those within the first bar - |chosen| classes cannot
  /// lead above the bar; the others are branches, in the order of their colours.
  void colour(std::size_t depth) {
    Level& here = level(depth);
    here.branches.clear();
    uncoloured_ = here.candidates;
    std::size_t left = count_bits(uncoloured_);
    const std::size_t harmless = bar_ > chosen_.size() ? bar_ - chosen_.size() : 0;
    for (std::size_t colours = 1; left > 0; ++colours) {
      take_class(*graph_, uncoloured_, free_, [&](std::size_t v) {
        if (colours > harmless) here.branches.push_back({v, colours});
        --left;
      });
    }
  }

  void expand(std::size_t depth) {
    colour(depth);
    level(depth + 1);
    for (auto k = levels_[depth].branches.size(); k-- > 0 && !budget_->exhausted();) {
      const auto [v, colours] = levels_[depth].branches[k];
      if (chosen_.size() + colours <= bar_) return;
      ++budget_->spent;
      choose(depth, v);
      clear_bit(levels_[depth].candidates, v);
    }
  }

  void choose(std::size_t depth, std::size_t v) {
    const auto neighbours = graph_->neighbours(v);
    const auto& from = levels_[depth].candidates;
    auto& to = levels_[depth + 1].candidates;
    BitWord any = 0;
    for (std::size_t w = 0; w < to.size(); ++w) any |= to[w] = from[w] & neighbours[w];
    chosen_.push_back(v);
    if (any != 0)
      expand(depth + 1);
    else if (chosen_.size() > bar_)
      best_ = chosen_, bar_ = chosen_.size();
    chosen_.pop_back();
  }

  const UndirectedGraph* graph_;
  Budget* budget_;
  std::size_t bar_ = 0;
  std::vector<std::size_t> chosen_, best_;
  std::vector<Level> levels_;
  std::vector<BitWord> uncoloured_, free_;
};

/// The neighbours of the vertex at `place` that come later in the order and can be in a clique above the bar.
std::vector<std::size_t> later_neighbours(const UndirectedGraph& graph, const Degeneracy& degeneracy,
                                          std::size_t place, std::size_t bar) {
  std::vector<std::size_t> later;
  for (std::size_t k = degeneracy.order.size(); k-- > place + 1;) {  // the dense part first
    const std::size_t u = degeneracy.order[k];
    if (degeneracy.core[u] >= bar && graph.connected(degeneracy.order[place], u)) later.push_back(u);
  }
  return later;
}

/// A larger clique than `best` whose first vertex in the order is at `place`, if there is one.
void improve_at(const UndirectedGraph& graph, const Degeneracy& degeneracy, std::size_t place, Budget& budget,
                std::vector<std::size_t>& best) {
  const std::size_t v = degeneracy.order[place];
  if (degeneracy.core[v] < best.size()) return;
  const auto later = later_neighbours(graph, degeneracy, place, best.size());
  if (later.size() < best.size()) return;
  std::vector<BitWord> as_bits(graph.words());
  for (const std::size_t u : later) set_bit(as_bits, u);
  if (colours_suffice(graph, as_bits, best.size() - 1)) return;
  const auto induced = induced_graph(graph, later);
  const auto found = CliqueSearch(induced, budget).larger_than(best.size() - 1);
  if (found.empty()) return;
  best = {v};
  for (const std::size_t u : found) best.push_back(later[u]);
}

}  // namespace

Degeneracy degeneracy(const UndirectedGraph& graph) {
  DegreeBins bins(graph);
  for (std::size_t place = 0; place < graph.size(); ++place) {
    const std::size_t v = bins.at(place);
    for_each_bit(graph.neighbours(v), [&](std::size_t u) {
      if (bins.degree(u) > bins.degree(v)) bins.lose_neighbour(u);
    });
  }
  Degeneracy result{bins.order(), std::vector<std::size_t>(graph.size())};
  for (std::size_t v = 0; v < graph.size(); ++v) result.core[v] = bins.degree(v);
  return result;
}

std::vector<std::size_t> greedy_clique(const UndirectedGraph& graph, const Degeneracy& degeneracy,
                                       std::size_t starts) {
  std::vector<std::size_t> best;
  const auto is_known = [&](std::size_t v) { return std::find(best.begin(), best.end(), v) != best.end(); };
  for (std::size_t k = 0; k < std::min(starts, graph.size()); ++k) {
    const std::size_t start = degeneracy.order[graph.size() - 1 - k];
    if (degeneracy.core[start] < best.size()) break;  // no later start has a larger core number
    if (is_known(start)) continue;                    // would most likely lead to the same
    auto clique = clique_from(graph, start);
    if (clique.size() > best.size()) best = std::move(clique);
  }
  return best;
}

MaximumClique maximum_clique(const UndirectedGraph& graph, const MaximumCliqueParams& params) {
  MaximumClique result;
  if (graph.size() == 0) return result;
  const Degeneracy order = degeneracy(graph);
  result.vertices = greedy_clique(graph, order, static_cast<std::size_t>(params.greedy_starts));
  Budget budget{0, static_cast<std::uint64_t>(params.max_branches)};
  for (std::size_t place = graph.size(); place-- > 0 && !budget.exhausted();)
    improve_at(graph, order, place, budget, result.vertices);
  std::sort(result.vertices.begin(), result.vertices.end());
  result.proven = !budget.exhausted();
  result.branches = budget.spent;
  return result;
}

}  // namespace radioslam
