#include "radioslam/radio/place_order.hpp"

#include <algorithm>
#include <optional>

namespace radioslam {
namespace {

bool hears(const Fingerprint& fingerprint, AccessPointIndex access_point) {
  const auto place = std::lower_bound(
      fingerprint.entries.begin(), fingerprint.entries.end(), access_point,
      [](const FingerprintEntry& entry, AccessPointIndex sought) { return entry.access_point < sought; });
  return place != fingerprint.entries.end() && place->access_point == access_point;
}

class PlaceOrder {
 public:
  PlaceOrder(const std::vector<Fingerprint>& all, std::size_t access_points, std::size_t part)
      : all_(&all), part_(part), hearers_(access_points, 0) {}

  void order(std::span<std::uint32_t> members) {
    while (members.size() > part_) {
      const auto cut = best_cut(members);
      if (!cut) return;
      const auto middle = std::stable_partition(members.begin(), members.end(),
                                                [&](std::uint32_t i) { return hears((*all_)[i], *cut); });
      const auto hearing = static_cast<std::size_t>(middle - members.begin());
      order(members.first(hearing));
      members = members.subspan(hearing);
    }
  }

 private:
  /// Nothing where all hear the same.
  std::optional<AccessPointIndex> best_cut(std::span<const std::uint32_t> members) {
    heard_.clear();
    for (const std::uint32_t i : members)
      for (const auto& entry : (*all_)[i].entries)
        if (hearers_[entry.access_point.index()]++ == 0) heard_.push_back(entry.access_point);
    std::optional<AccessPointIndex> best;
    std::size_t best_off = members.size();
    for (const AccessPointIndex ap : heard_) {
      const std::size_t twice = 2 * hearers_[ap.index()];
      const std::size_t off = twice > members.size() ? twice - members.size() : members.size() - twice;
      hearers_[ap.index()] = 0;
      if (off < best_off || (best && off == best_off && ap < *best)) {
        best = ap;
        best_off = off;
      }
    }
    return best;
  }

  const std::vector<Fingerprint>* all_;
  std::size_t part_;
  std::vector<std::size_t> hearers_;  ///< per access point; 0 between calls
  std::vector<AccessPointIndex> heard_;
};

}  // namespace

void order_by_place(const std::vector<Fingerprint>& all, std::size_t access_points, std::size_t part,
                    std::span<std::uint32_t> members) {
  PlaceOrder(all, access_points, part).order(members);
}

}  // namespace radioslam
