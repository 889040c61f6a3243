#include "radioslam/radio/fingerprints/join_rows.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "radioslam/base/check.hpp"

namespace radioslam {
namespace {

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

}  // namespace

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

}  // namespace radioslam
