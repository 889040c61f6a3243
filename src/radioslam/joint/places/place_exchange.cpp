#include "radioslam/joint/places/place_exchange.hpp"

#include <cmath>

namespace radioslam {
namespace {

constexpr std::size_t kSurfelBytes = 21;

std::size_t scan_bytes(const StoredCloud& scan) { return kSurfelBytes * scan.points(); }

}  // namespace

void PlaceExchange::send_descriptor(const std::vector<ScannedRobot>& robots, std::size_t a, std::size_t b,
                                    std::size_t j) {
  if (descriptors_.insert({a, b, j}).second) sent_.descriptors += wire_bytes(robots[b].contexts->context(j));
}

void PlaceExchange::send_scans(const std::vector<ScannedRobot>& robots, const Proposal& pair,
                               double source_m) {
  const ScannedRobot& b = robots[pair.b];
  for (std::size_t k = 0; k < b.size(); ++k) {
    if (k != pair.j && !(std::abs(b.path_m[k] - b.path_m[pair.j]) < source_m)) continue;
    if (scans_.insert({pair.a, pair.b, k}).second) sent_.scans += scan_bytes(b.cloud(k));
  }
}

PlaceBytes bytes_of_all(const ScannedRobot& b, const std::vector<std::size_t>& described) {
  PlaceBytes all;
  for (const std::size_t j : described) all.descriptors += wire_bytes(b.contexts->context(j));
  for (std::size_t k = 0; k < b.size(); ++k) all.scans += scan_bytes(b.cloud(k));
  return all;
}

}  // namespace radioslam
