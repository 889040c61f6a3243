#include "radioslam/radio/fingerprints/similarity_join.hpp"

#include <algorithm>
#include <limits>

#include "radioslam/base/parallel.hpp"
#include "radioslam/radio/fingerprints/join_rows.hpp"

namespace radioslam {
namespace {

std::size_t access_points_in(const std::vector<Fingerprint>& fingerprints) {
  std::size_t count = 0;
  for (const auto& fingerprint : fingerprints)
    if (!fingerprint.entries.empty())
      count = std::max(count, fingerprint.entries.back().access_point.index() + 1);
  return count;
}

}  // namespace

SimilarityJoin::SimilarityJoin(const std::vector<Fingerprint>& rows, const std::vector<Fingerprint>& columns,
                               const SimilarityQuery& query)
    : rows_(&rows),
      columns_(&columns),
      query_(query),
      blocks_(fingerprint_blocks(columns, std::max(access_points_in(rows), access_points_in(columns)),
                                 query.measure, query.params)) {}

SimilarityJoin SimilarityJoin::within(const std::vector<Fingerprint>& fingerprints,
                                      const SimilarityQuery& query) {
  return {fingerprints, fingerprints, query};
}

SimilarityJoin SimilarityJoin::between(const std::vector<Fingerprint>& rows,
                                       const std::vector<Fingerprint>& columns,
                                       const SimilarityQuery& query) {
  return {rows, columns, query};
}

std::vector<SimilarPair> SimilarityJoin::pairs_of(std::size_t begin, std::size_t end) const {
  std::vector<SimilarPair> pairs;
  for (std::size_t first = begin; first < end; first += kRowsTogether) {
    const std::size_t last = std::min(end, first + kRowsTogether);
    const auto found = reaching_pairs_of(first, last);
    pairs.insert(pairs.end(), found.begin(), found.end());
  }
  return query_.minimum > 0 ? pairs : with_zeros(pairs, begin, end);
}

std::vector<SimilarPair> SimilarityJoin::reaching_pairs_of(std::size_t begin, std::size_t end) const {
  // Without a minimum: all pairs of positive similarity.
  SimilarityQuery query = query_;
  if (query.minimum <= 0) query.minimum = static_cast<double>(std::numeric_limits<float>::denorm_min());
  JoinedRows joined(blocks_, query, rows_ == columns_ ? JoinedPairs::kLaterOnes : JoinedPairs::kAll);
  for (std::size_t i = begin; i < end; ++i) joined.add((*rows_)[i], static_cast<std::uint32_t>(i));
  return joined.pairs(*columns_);
}

std::vector<SimilarPair> SimilarityJoin::with_zeros(const std::vector<SimilarPair>& pairs, std::size_t begin,
                                                    std::size_t end) const {
  std::vector<SimilarPair> all;
  auto next = pairs.begin();
  for (std::size_t i = begin; i < end; ++i) {
    for (std::size_t j = first_column(i); j < columns_->size(); ++j) {
      const SimilarPair nothing{static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j), 0};
      const bool is_found = next != pairs.end() && next->i == nothing.i && next->j == nothing.j;
      all.push_back(is_found ? *next++ : nothing);
    }
  }
  return all;
}

std::vector<SimilarPair> SimilarityJoin::pairs() const {
  const std::size_t groups = (rows() + kRowsTogether - 1) / kRowsTogether;
  std::vector<std::vector<SimilarPair>> found(groups);
  parallel_for(groups, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g)
      found[g] = pairs_of(g * kRowsTogether, std::min(rows(), (g + 1) * kRowsTogether));
  });
  std::vector<SimilarPair> all;
  for (const auto& group : found) all.insert(all.end(), group.begin(), group.end());
  return all;
}

}  // namespace radioslam
