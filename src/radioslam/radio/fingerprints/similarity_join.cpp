#include "radioslam/radio/fingerprints/similarity_join.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

#include "radioslam/base/check.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/radio/fingerprints/similarity_lanes.hpp"
#include "radioslam/radio/fingerprints/similarity_sums.hpp"

namespace radioslam {
namespace {

constexpr double kImpossible = std::numeric_limits<double>::infinity();
constexpr double kRoundedSums = 1e-9;  // far above the rounding error of the sums

std::vector<double> need_weights(const Fingerprint& fingerprint, SimilarityMeasure measure,
                                 const SimilarityParams& params) {
  std::vector<double> weights;
  for (const auto& entry : fingerprint.entries) {
    const double shifted = shifted_rss_db(entry.rss_dbm);
    weights.push_back(measure == SimilarityMeasure::kCosine ? shifted * shifted
                      : measure == SimilarityMeasure::kSorensen
                          ? static_cast<double>(compared_value(entry, measure, params))
                          : 1);
  }
  return weights;
}

/// `all` is the weight of the whole fingerprint.
double min_shared(double all, double s, SimilarityMeasure measure, const SimilarityParams& params) {
  switch (measure) {
    case SimilarityMeasure::kCosine:
      return s * s * all;
    case SimilarityMeasure::kSorensen:
      return s / (2 - s) * all;
    case SimilarityMeasure::kProduct:
      return s * all <= 1 ? 1 : kImpossible;
    case SimilarityMeasure::kGeometricMean:
      return params.min_shared;
    case SimilarityMeasure::kGaussian:
    case SimilarityMeasure::kDetection:
      break;
  }
  return s * all;
}

// One task of the similarity join (similarity_join.hpp): joins up to one fingerprint per bit of RowBits with
// all blocks. Successive rows of a recording need the same blocks, whose columns then stay in the cache.

/// One bit per row.
using RowBits = std::uint32_t;

enum class JoinedPairs {
  kAll,
  kLaterOnes,  ///< a recording with itself: only j > i
};

/// Matches of a row in one slab: a similarity per lane, and which lanes have one.
struct SlabMatches {
  std::vector<float> similarity = std::vector<float>(kSlabLanes);
  std::vector<std::uint64_t> has = std::vector<std::uint64_t>(kSlabLanes / 64);
};

class JoinedRows {
 public:
  /// `query.minimum` > 0.
  JoinedRows(const FingerprintBlocks& blocks, const SimilarityQuery& query, JoinedPairs which);
  void add(const Fingerprint& row, std::uint32_t index);
  /// Pairs of all rows, ordered; `columns` are the fingerprints in the blocks.
  std::vector<SimilarPair> pairs(const std::vector<Fingerprint>& columns);

 private:
  struct Row {
    const Fingerprint* fingerprint;
    std::uint32_t index;
    SharedWeightBound need;
    FingerprintTotals totals;
    LaneQuery query;
    std::vector<std::uint32_t> local;  ///< per entry: its access point's index among those of all rows
    std::vector<float> values;         ///< per entry: compared_value()
    SlabMatches matches;
    std::vector<SimilarPair> pairs;
  };

  LaneQuery lane_query(const FingerprintTotals& totals) const;
  std::uint32_t local_of(AccessPointIndex access_point);
  void want_blocks();
  void join_slab(std::size_t slab);
  void join_block(std::size_t b);
  void compare(Row& row, const FingerprintBlock& block);
  LaneBits allowed_lanes(const Row& row, const FingerprintBlock& block) const;
  void accept(Row& row, const FingerprintBlock& block, std::size_t lane, const LaneSums& sums);
  void collect(Row& row, std::size_t slab);

  const FingerprintBlocks* blocks_;
  SimilarityQuery query_;
  JoinedPairs which_;
  SimilarityKernel kernel_;
  const std::vector<Fingerprint>* columns_ = nullptr;
  std::vector<Row> rows_;
  std::vector<std::uint32_t> locals_;    ///< per access point: its local index, 0 if no row has it
  std::vector<AccessPointIndex> heard_;  ///< per local index
  std::vector<RowBits> wanting_;         ///< per local index: rows with it in their prefix
  std::vector<RowBits> wanted_;          ///< per block: rows that may have a match in it
  std::vector<const float*> column_;     ///< per local index: column of the current block, or null
  std::vector<SharedColumn> shared_columns_;
};

/// Lower bound on similarities that may round to a float of `minimum`, with margin for the tests' rounding.
double rounded_below(double minimum) {
  constexpr double kRounding = 1e-6, kSmallestHalf = 0.5 * 1.401298464324817e-45;
  return std::max((1 - kRounding) * minimum - kSmallestHalf, std::numeric_limits<double>::min());
}

/// Adds the detection rates of shared access points, in their order, as the detection measure needs.
void add_shared_detections(const Fingerprint& row, const Fingerprint& column, SharedSums& sums) {
  auto j = column.entries.begin();
  for (const auto& entry : row.entries) {
    while (j != column.entries.end() && j->access_point < entry.access_point) ++j;
    if (j == column.entries.end()) return;
    if (j->access_point != entry.access_point) continue;
    const double tau_i = static_cast<double>(entry.detection_rate),
                 tau_j = static_cast<double>(j->detection_rate);
    sums.detection2_i += tau_i * tau_i;
    sums.detection2_j += tau_j * tau_j;
  }
}

JoinedRows::JoinedRows(const FingerprintBlocks& blocks, const SimilarityQuery& query, JoinedPairs which)
    : blocks_(&blocks),
      query_(query),
      which_(which),
      kernel_(similarity_kernel(query.measure)),
      locals_(blocks.holders.size(), 0),
      heard_(1),
      wanting_(1, 0),
      wanted_(blocks.blocks.size(), 0) {}

LaneQuery JoinedRows::lane_query(const FingerprintTotals& totals) const {
  const auto& params = query_.params;
  const bool detects = query_.measure == SimilarityMeasure::kDetection;
  LaneQuery query;
  query.least = rounded_below(query_.minimum);
  query.heard = totals.heard;
  query.total = totals.total;
  query.min_detection2 = totals.min_detection2;
  query.per_db2 = 1 / (2 * params.sigma_rss_db * params.sigma_rss_db);
  query.per_detection2 = detects ? 1 / (2 * params.sigma_detection * params.sigma_detection) : 0;
  query.min_shared = params.min_shared;
  return query;
}

std::uint32_t JoinedRows::local_of(AccessPointIndex access_point) {
  std::uint32_t& local = locals_[access_point.index()];
  if (local == 0) {
    local = static_cast<std::uint32_t>(heard_.size());
    heard_.push_back(access_point);
    wanting_.push_back(0);
  }
  return local;
}

void JoinedRows::add(const Fingerprint& row, std::uint32_t index) {
  RADIOSLAM_CHECK(rows_.size() < std::numeric_limits<RowBits>::digits, "at most one row per bit");
  const FingerprintTotals totals = totals_of(row, query_.measure, query_.params);
  const LaneQuery query = lane_query(totals);
  SharedWeightBound need = shared_weight_bound(row, query.least, query_.measure, query_.params);
  Row added{&row, index, std::move(need), totals, query, {}, {}, {}, {}};
  for (const auto& entry : row.entries) {
    added.local.push_back(local_of(entry.access_point));
    added.values.push_back(compared_value(entry, query_.measure, query_.params));
  }
  for (const std::size_t k : join_prefix(row, added.need, blocks_->holders))
    wanting_[added.local[k]] |= RowBits{1} << rows_.size();
  rows_.push_back(std::move(added));
}

void JoinedRows::want_blocks() {
  for (std::size_t local = 1; local < heard_.size(); ++local) {
    if (wanting_[local] == 0) continue;
    for (const std::uint32_t b : blocks_->holders[heard_[local].index()]) wanted_[b] |= wanting_[local];
  }
}

std::vector<SimilarPair> JoinedRows::pairs(const std::vector<Fingerprint>& columns) {
  columns_ = &columns;
  column_.assign(heard_.size(), nullptr);
  want_blocks();
  for (std::size_t slab = 0; slab * kBlocksPerSlab < blocks_->blocks.size(); ++slab) join_slab(slab);
  std::vector<SimilarPair> all;
  for (const Row& row : rows_) all.insert(all.end(), row.pairs.begin(), row.pairs.end());
  return all;
}

void JoinedRows::join_slab(std::size_t slab) {
  const std::size_t begin = slab * kBlocksPerSlab;
  const std::size_t end = std::min(blocks_->blocks.size(), begin + kBlocksPerSlab);
  for (std::size_t b = begin; b < end; ++b)
    if (wanted_[b] != 0) join_block(b);
  for (Row& row : rows_) collect(row, slab);
}

void JoinedRows::join_block(std::size_t b) {
  const FingerprintBlock& block = blocks_->blocks[b];
  if (which_ == JoinedPairs::kLaterOnes && block.fingerprints.back() <= rows_.front().index) return;
  for (std::size_t c = 0; c < block.access_points.size(); ++c)
    column_[locals_[block.access_points[c].index()]] = block.column(c);
  column_[0] = nullptr;  // access points that no row has
  for (RowBits left = wanted_[b]; left != 0; left &= left - 1)
    compare(rows_[static_cast<std::size_t>(std::countr_zero(left))], block);
  for (const AccessPointIndex ap : block.access_points) column_[locals_[ap.index()]] = nullptr;
}

void JoinedRows::compare(Row& row, const FingerprintBlock& block) {
  const LaneBits allowed = allowed_lanes(row, block);
  if (allowed == 0) return;
  shared_columns_.resize(row.local.size());
  std::size_t count = 0;
  double weight = 0;
  for (std::size_t k = 0; k < row.local.size(); ++k) {
    const float* const values = column_[row.local[k]];
    shared_columns_[count] = {values, row.values[k]};
    count += values != nullptr ? 1 : 0;
    weight += values != nullptr ? row.need.weights[k] : 0;
  }
  if (count == 0 || weight < row.need.least) return;
  LaneSums sums;
  kernel_.sum(shared_columns_.data(), count, sums);
  for (LaneBits left = kernel_.reaching(sums, block.lanes, row.query) & allowed; left != 0; left &= left - 1)
    accept(row, block, static_cast<std::size_t>(std::countr_zero(left)), sums);
}

LaneBits JoinedRows::allowed_lanes(const Row& row, const FingerprintBlock& block) const {
  const std::size_t lanes = block.fingerprints.size();
  const LaneBits all = ~LaneBits{0} >> (kLanes - lanes);
  if (which_ == JoinedPairs::kAll) return all;
  const auto later = std::upper_bound(block.fingerprints.begin(), block.fingerprints.end(), row.index);
  const auto earlier = static_cast<std::size_t>(later - block.fingerprints.begin());
  return earlier == kLanes ? 0 : all & (~LaneBits{0} << earlier);
}

void JoinedRows::accept(Row& row, const FingerprintBlock& block, std::size_t lane, const LaneSums& sums) {
  SharedSums shared{static_cast<int>(sums.shared[lane]), sums.sum[lane], 0, 0};
  const std::uint32_t j = block.fingerprints[lane];
  if (query_.measure == SimilarityMeasure::kDetection)
    add_shared_detections(*row.fingerprint, (*columns_)[j], shared);
  const auto similarity = static_cast<float>(
      similarity_of(shared, row.totals, block.totals[lane], query_.measure, query_.params));
  if (static_cast<double>(similarity) < query_.minimum) return;
  const std::size_t lane_in_slab = j % kSlabLanes;
  row.matches.similarity[lane_in_slab] = similarity;
  row.matches.has[lane_in_slab / 64] |= std::uint64_t{1} << (lane_in_slab % 64);
}

void JoinedRows::collect(Row& row, std::size_t slab) {
  for (std::size_t word = 0; word < row.matches.has.size(); ++word) {
    for (std::uint64_t left = row.matches.has[word]; left != 0; left &= left - 1) {
      const std::size_t lane_in_slab = 64 * word + static_cast<std::size_t>(std::countr_zero(left));
      row.pairs.push_back({row.index, static_cast<std::uint32_t>(slab * kSlabLanes + lane_in_slab),
                           row.matches.similarity[lane_in_slab]});
    }
    row.matches.has[word] = 0;
  }
}

std::size_t access_points_in(const std::vector<Fingerprint>& fingerprints) {
  std::size_t count = 0;
  for (const auto& fingerprint : fingerprints)
    if (!fingerprint.entries.empty())
      count = std::max(count, fingerprint.entries.back().access_point.index() + 1);
  return count;
}

}  // namespace

SharedWeightBound shared_weight_bound(const Fingerprint& fingerprint, double min_similarity,
                                      SimilarityMeasure measure, const SimilarityParams& params) {
  SharedWeightBound need{need_weights(fingerprint, measure, params), 0};
  const double all = std::accumulate(need.weights.begin(), need.weights.end(), 0.0);
  need.least = all > 0 ? (1 - kRoundedSums) * min_shared(all, min_similarity, measure, params) : kImpossible;
  return need;
}

std::vector<std::size_t> join_prefix(const Fingerprint& fingerprint, const SharedWeightBound& need,
                                     const std::vector<std::vector<std::uint32_t>>& holders) {
  std::vector<std::size_t> entries(fingerprint.entries.size());
  std::iota(entries.begin(), entries.end(), std::size_t{0});
  std::stable_sort(entries.begin(), entries.end(), [&](std::size_t a, std::size_t b) {
    return holders[fingerprint.entries[a].access_point.index()].size() <
           holders[fingerprint.entries[b].access_point.index()].size();
  });
  double left_out = 0;
  while (!entries.empty() && left_out + need.weights[entries.back()] < need.least) {
    left_out += need.weights[entries.back()];
    entries.pop_back();
  }
  return entries;
}

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
