#include "radioslam/consistency/degeneracy.hpp"

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

}  // namespace radioslam
