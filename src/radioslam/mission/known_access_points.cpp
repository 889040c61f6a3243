#include "radioslam/mission/known_access_points.hpp"

#include <algorithm>

namespace radioslam {
namespace {

/// Lower case with ':' between the bytes.
std::string plain_address(std::string name) {
  for (char& c : name) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (c == '-') c = ':';
  }
  return name;
}

}  // namespace

std::vector<KnownAccessPoint> known_access_points(const Mission& mission) {
  std::vector<KnownAccessPoint> known;
  for (const Anchor& anchor : mission.anchors) {
    if (!anchor.position_m) continue;
    const std::string address = plain_address(anchor.id);
    const auto& all = mission.access_points;
    const auto found = std::lower_bound(all.begin(), all.end(), address);
    if (found != all.end() && *found == address)
      known.push_back({AccessPointIndex(static_cast<std::size_t>(found - all.begin())),
                       anchor.position_m->head<2>(), anchor.sigma_m});
  }
  std::stable_sort(known.begin(), known.end(), [](const KnownAccessPoint& a, const KnownAccessPoint& b) {
    return a.access_point < b.access_point;
  });
  return known;
}

}  // namespace radioslam
