#include "radioslam/consistency/undirected_graph.hpp"

#include "radioslam/base/check.hpp"

namespace radioslam {

std::size_t count_bits(std::span<const BitWord> words) {
  std::size_t count = 0;
  for (const BitWord word : words) count += static_cast<std::size_t>(std::popcount(word));
  return count;
}

std::size_t count_common_bits(std::span<const BitWord> a, std::span<const BitWord> b) {
  std::size_t count = 0;
  for (std::size_t w = 0; w < a.size(); ++w) count += static_cast<std::size_t>(std::popcount(a[w] & b[w]));
  return count;
}

UndirectedGraph::UndirectedGraph(std::size_t size)
    : size_(size), words_(words_for(size)), bits_(size * words_for(size)) {}

void UndirectedGraph::connect(std::size_t i, std::size_t j) {
  RADIOSLAM_CHECK(i != j && i < size_ && j < size_, "an edge joins two vertices of the graph");
  set_bit({bits_.data() + i * words_, words_}, j);
  set_bit({bits_.data() + j * words_, words_}, i);
}

std::size_t UndirectedGraph::edges() const { return count_bits(bits_) / 2; }

UndirectedGraph induced_graph(const UndirectedGraph& graph, std::span<const std::size_t> vertices) {
  UndirectedGraph induced(vertices.size());
  std::vector<BitWord> wanted(graph.words()), common(graph.words());
  std::vector<std::size_t> numbers(graph.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const auto row = graph.neighbours(vertices[i]);
    for (std::size_t w = 0; w < common.size(); ++w) common[w] = row[w] & wanted[w];
    for_each_bit(common, [&](std::size_t u) { induced.connect(i, numbers[u]); });
    numbers[vertices[i]] = i;
    set_bit(wanted, vertices[i]);
  }
  return induced;
}

}  // namespace radioslam
