#include "radioslam/radio/fingerprints/locality_order.hpp"

#include <algorithm>
#include <optional>

namespace radioslam {
namespace {

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

}  // namespace

void order_by_locality(const std::vector<Fingerprint>& all, std::size_t access_points, std::size_t part,
                       std::span<std::uint32_t> members) {
  PlaceOrder(all, access_points, part).order(members);
}

}  // namespace radioslam
