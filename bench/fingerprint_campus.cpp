#include "fingerprint_campus.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

constexpr double kReach_m = 110, kShadowCell_m = 8;
constexpr double kPowerAtMetre_dbm = -35, kPathLossExponent = 3;
constexpr double kSigmaShadow_db = 6, kSigmaNoise_db = 3;
constexpr double kAlwaysDetected_dbm = -80, kNeverDetected_dbm = -110;

struct Place {
  double x_m = 0, y_m = 0;
};

/// Access points in a grid with cells as wide as their range.
class AccessPointMap {
 public:
  AccessPointMap(const Campus& campus, Rng rng)
      : cells_(static_cast<std::size_t>(std::ceil(campus.side_m / kReach_m))), grid_(cells_ * cells_) {
    for (std::size_t k = 0; k < campus.access_points; ++k) {
      const double x_m = rng.uniform(0, campus.side_m), y_m = rng.uniform(0, campus.side_m);
      places_.push_back({x_m, y_m});
      grid_[cell(x_m) * cells_ + cell(y_m)].push_back(k);
    }
  }
  const Place& at(std::size_t access_point) const { return places_[access_point]; }

  template <class Use>
  void near(const Place& place, Use&& use) const {
    const std::size_t cx = cell(place.x_m), cy = cell(place.y_m);
    for (std::size_t x = cx - std::min<std::size_t>(cx, 1); x <= std::min(cx + 1, cells_ - 1); ++x)
      for (std::size_t y = cy - std::min<std::size_t>(cy, 1); y <= std::min(cy + 1, cells_ - 1); ++y)
        for (const std::size_t k : grid_[x * cells_ + y]) use(k);
  }

 private:
  std::size_t cell(double at_m) const {
    return std::min(cells_ - 1, static_cast<std::size_t>(std::max(0.0, at_m) / kReach_m));
  }

  std::size_t cells_;
  std::vector<std::vector<std::size_t>> grid_;
  std::vector<Place> places_;
};

/// Shadowing, constant per access point and cell.
double shadow_db(std::size_t access_point, const Place& place, std::uint64_t seed) {
  const auto cell = [](double at_m) { return static_cast<std::uint64_t>(at_m / kShadowCell_m) & 0xfffU; };
  const std::uint64_t key = (access_point << 24U) | (cell(place.x_m) << 12U) | cell(place.y_m);
  return Rng(key * 0x9e3779b97f4a7c15U ^ seed).normal(0, kSigmaShadow_db);
}

double distance_m(const Place& a, const Place& b) { return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m); }

double mean_rss_dbm(double range_m) {
  return kPowerAtMetre_dbm - 10 * kPathLossExponent * std::log10(std::max(1.0, range_m));
}

/// Entry of one access point over the scans of a window; detection rate 0 if it was not detected.
FingerprintEntry heard_entry(std::size_t access_point, double mean_dbm, int scans, Rng& rng) {
  const double chance = (mean_dbm - kNeverDetected_dbm) / (kAlwaysDetected_dbm - kNeverDetected_dbm);
  int heard = 0;
  double sum_dbm = 0;
  for (int s = 0; s < scans; ++s) {
    const double rss_dbm = std::round(mean_dbm + rng.normal(0, kSigmaNoise_db));
    if (rng.uniform() >= chance) continue;
    ++heard;
    sum_dbm += rss_dbm;
  }
  return {AccessPointIndex(access_point), static_cast<float>(sum_dbm / std::max(1, heard)),
          static_cast<float>(heard) / static_cast<float>(scans)};
}

Fingerprint fingerprint_at(const Place& place, const AccessPointMap& map, const Campus& campus, Rng& rng) {
  Fingerprint fingerprint{{}, campus.scans, {}};
  map.near(place, [&](std::size_t k) {
    const double range_m = distance_m(map.at(k), place);
    if (range_m > kReach_m) return;
    const double mean_dbm = mean_rss_dbm(range_m) + shadow_db(k, place, campus.seed);
    const FingerprintEntry entry = heard_entry(k, mean_dbm, campus.scans, rng);
    if (entry.detection_rate > 0) fingerprint.entries.push_back(entry);
  });
  auto& entries = fingerprint.entries;
  std::sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
    return a.rss_dbm != b.rss_dbm ? a.rss_dbm > b.rss_dbm : a.access_point < b.access_point;
  });
  if (entries.size() > campus.heard) entries.resize(campus.heard);
  std::sort(entries.begin(), entries.end(),
            [](const auto& a, const auto& b) { return a.access_point < b.access_point; });
  return fingerprint;
}

/// Random walk that turns slightly at every step, and back at the border.
class Walk {
 public:
  Walk(const Campus& campus, Rng& rng)
      : side_m_(campus.side_m),
        step_m_(campus.step_m),
        place_{rng.uniform(0, side_m_), rng.uniform(0, side_m_)},
        yaw_rad_(rng.uniform(0, 2 * std::numbers::pi)) {}

  const Place& next(Rng& rng) {
    yaw_rad_ += rng.normal(0, 0.3);
    const double x_m = place_.x_m + step_m_ * std::cos(yaw_rad_);
    const double y_m = place_.y_m + step_m_ * std::sin(yaw_rad_);
    const bool is_inside = std::min(x_m, y_m) >= 0 && std::max(x_m, y_m) <= side_m_;
    if (is_inside) place_ = {x_m, y_m};
    if (!is_inside) yaw_rad_ += std::numbers::pi;
    return place_;
  }

 private:
  double side_m_, step_m_;
  Place place_;
  double yaw_rad_;
};

}  // namespace

std::vector<Fingerprint> campus_fingerprints(const Campus& campus) {
  Rng rng(campus.seed);
  const AccessPointMap map(campus, Rng(campus.seed + 1));
  const std::size_t each = (campus.fingerprints + campus.walkers - 1) / campus.walkers;
  std::vector<Fingerprint> fingerprints;
  while (fingerprints.size() < campus.fingerprints) {
    Walk walk(campus, rng);
    for (std::size_t k = 0; k < each && fingerprints.size() < campus.fingerprints; ++k) {
      fingerprints.push_back(fingerprint_at(walk.next(rng), map, campus, rng));
      fingerprints.back().stamp = Stamp::from_seconds(static_cast<double>(fingerprints.size()) * 5);
    }
  }
  return fingerprints;
}

}  // namespace radioslam
