#include "radioslam/radio/fingerprints/fingerprint_blocks.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <span>

#include "radioslam/base/parallel.hpp"

namespace radioslam {
namespace {

// Locality order: orders fingerprints so that neighbours detect the same access points.

bool detects(const Fingerprint& fingerprint, AccessPointIndex access_point) {
  const auto found = std::lower_bound(
      fingerprint.entries.begin(), fingerprint.entries.end(), access_point,
      [](const FingerprintEntry& entry, AccessPointIndex sought) { return entry.access_point < sought; });
  return found != fingerprint.entries.end() && found->access_point == access_point;
}

class PlaceOrder {
 public:
  PlaceOrder(const std::vector<Fingerprint>& all, std::size_t access_points, std::size_t part)
      : all_(&all), part_(part), detections_(access_points, 0) {}

  void order(std::span<std::uint32_t> members) {
    while (members.size() > part_) {
      const auto cut = best_cut(members);
      if (!cut) return;
      const auto middle = std::stable_partition(members.begin(), members.end(),
                                                [&](std::uint32_t i) { return detects((*all_)[i], *cut); });
      const auto detecting = static_cast<std::size_t>(middle - members.begin());
      order(members.first(detecting));
      members = members.subspan(detecting);
    }
  }

 private:
  /// The access point to split by; nothing where all members detect the same ones.
  std::optional<AccessPointIndex> best_cut(std::span<const std::uint32_t> members) {
    detected_.clear();
    for (const std::uint32_t i : members)
      for (const auto& entry : (*all_)[i].entries)
        if (detections_[entry.access_point.index()]++ == 0) detected_.push_back(entry.access_point);
    std::optional<AccessPointIndex> best;
    std::size_t best_off = members.size();
    for (const AccessPointIndex ap : detected_) {
      const std::size_t twice = 2 * detections_[ap.index()];
      const std::size_t off = twice > members.size() ? twice - members.size() : members.size() - twice;
      detections_[ap.index()] = 0;
      if (off < best_off || (best && off == best_off && ap < *best)) {
        best = ap;
        best_off = off;
      }
    }
    return best;
  }

  const std::vector<Fingerprint>* all_;
  std::size_t part_;
  std::vector<std::size_t> detections_;  ///< per access point; 0 between calls
  std::vector<AccessPointIndex> detected_;
};

/// Orders `members` (indices into `all`): splits them by the access point that closest to half of them
/// detect, those that do first, and repeats down to groups of `part`. `access_points` exceeds any index.
/// Cost: entries times depth of the splits.
void order_by_locality(const std::vector<Fingerprint>& all, std::size_t access_points, std::size_t part,
                       std::span<std::uint32_t> members) {
  PlaceOrder(all, access_points, part).order(members);
}

constexpr std::size_t kBlocksPerTask = 8;

/// Order of the fingerprints slab by slab; within a slab, neighbours detect the same access points.
std::vector<std::uint32_t> block_order(const std::vector<Fingerprint>& fingerprints,
                                       std::size_t access_points) {
  std::vector<std::uint32_t> order(fingerprints.size());
  std::iota(order.begin(), order.end(), 0U);
  parallel_for((order.size() + kSlabLanes - 1) / kSlabLanes, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t slab = begin; slab < end; ++slab) {
      const auto members = std::span(order).subspan(slab * kSlabLanes);
      order_by_locality(fingerprints, access_points, kLanes,
                        members.first(std::min(members.size(), kSlabLanes)));
    }
  });
  return order;
}

std::vector<AccessPointIndex> access_points_of(const std::vector<Fingerprint>& all,
                                               std::span<const std::uint32_t> members) {
  std::vector<AccessPointIndex> heard;
  for (const std::uint32_t i : members)
    for (const auto& entry : all[i].entries) heard.push_back(entry.access_point);
  std::sort(heard.begin(), heard.end());
  heard.erase(std::unique(heard.begin(), heard.end()), heard.end());
  return heard;
}

void fill_lane(const Fingerprint& fingerprint, std::size_t lane, SimilarityMeasure measure,
               const SimilarityParams& params, FingerprintBlock& block) {
  std::size_t column = 0;
  for (const auto& entry : fingerprint.entries) {
    while (block.access_points[column] < entry.access_point) ++column;
    block.values[column * kLanes + lane] = compared_value(entry, measure, params);
  }
  const FingerprintTotals totals = totals_of(fingerprint, measure, params);
  block.totals.push_back(totals);
  block.lanes.heard[lane] = totals.heard;
  block.lanes.total[lane] = totals.total;
  block.lanes.min_detection2[lane] = totals.min_detection2;
}

FingerprintBlock block_of(const std::vector<Fingerprint>& all, std::span<const std::uint32_t> members,
                          SimilarityMeasure measure, const SimilarityParams& params) {
  FingerprintBlock block;
  block.fingerprints.assign(members.begin(), members.end());
  std::sort(block.fingerprints.begin(), block.fingerprints.end());
  block.access_points = access_points_of(all, members);
  const float unheard = measure == SimilarityMeasure::kSorensen ? 0 : kUndetectedValue;
  block.values.assign(block.access_points.size() * kLanes, unheard);
  for (std::size_t lane = 0; lane < members.size(); ++lane)
    fill_lane(all[block.fingerprints[lane]], lane, measure, params, block);
  return block;
}

}  // namespace

FingerprintBlocks fingerprint_blocks(const std::vector<Fingerprint>& fingerprints, std::size_t access_points,
                                     SimilarityMeasure measure, const SimilarityParams& params) {
  const std::vector<std::uint32_t> order = block_order(fingerprints, access_points);
  FingerprintBlocks result;
  result.blocks.resize((order.size() + kLanes - 1) / kLanes);
  parallel_for(result.blocks.size(), kBlocksPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const auto members = std::span(order).subspan(b * kLanes);
      result.blocks[b] =
          block_of(fingerprints, members.first(std::min(members.size(), kLanes)), measure, params);
    }
  });
  result.holders.resize(access_points);
  for (std::size_t b = 0; b < result.blocks.size(); ++b)
    for (const AccessPointIndex ap : result.blocks[b].access_points)
      result.holders[ap.index()].push_back(static_cast<std::uint32_t>(b));
  return result;
}

}  // namespace radioslam
