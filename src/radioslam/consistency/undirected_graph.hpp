// Undirected graph with one bit per pair of vertices: n^2 / 8 bytes. No loops, no double edges.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace radioslam {

/// A set of small numbers as the bits of words.
using BitWord = std::uint64_t;
inline constexpr std::size_t kBitsPerWord = 64;

inline std::size_t words_for(std::size_t bits) { return (bits + kBitsPerWord - 1) / kBitsPerWord; }
inline BitWord bit_of(std::size_t i) { return BitWord{1} << (i % kBitsPerWord); }
inline bool has_bit(std::span<const BitWord> words, std::size_t i) {
  return (words[i / kBitsPerWord] & bit_of(i)) != 0;
}
inline void set_bit(std::span<BitWord> words, std::size_t i) { words[i / kBitsPerWord] |= bit_of(i); }
inline void clear_bit(std::span<BitWord> words, std::size_t i) { words[i / kBitsPerWord] &= ~bit_of(i); }

/// Calls visit(i) for every bit that is set, from the lowest on.
template <class Visit>
void for_each_bit(std::span<const BitWord> words, Visit&& visit) {
  for (std::size_t w = 0; w < words.size(); ++w)
    for (BitWord rest = words[w]; rest != 0; rest &= rest - 1)
      visit(w * kBitsPerWord + static_cast<std::size_t>(std::countr_zero(rest)));
}

std::size_t count_bits(std::span<const BitWord> words);
/// Of those in both.
std::size_t count_common_bits(std::span<const BitWord> a, std::span<const BitWord> b);

/// An undirected graph over vertices 0 .. size() - 1.
class UndirectedGraph {
 public:
  explicit UndirectedGraph(std::size_t size = 0);

  std::size_t size() const { return size_; }
  std::size_t words() const { return words_; }
  /// i != j.
  void connect(std::size_t i, std::size_t j);
  bool connected(std::size_t i, std::size_t j) const { return has_bit(neighbours(i), j); }
  std::span<const BitWord> neighbours(std::size_t i) const { return {bits_.data() + i * words_, words_}; }
  std::size_t degree(std::size_t i) const { return count_bits(neighbours(i)); }
  std::size_t edges() const;

 private:
  std::size_t size_ = 0, words_ = 0;
  std::vector<BitWord> bits_;
};

/// The graph among `vertices`, renumbered in their order.
UndirectedGraph induced_graph(const UndirectedGraph& graph, std::span<const std::size_t> vertices);

}  // namespace radioslam
