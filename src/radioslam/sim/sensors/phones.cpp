#include "radioslam/sim/sensors/phones.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/base/check.hpp"
#include "radioslam/base/units.hpp"
#include "radioslam/sim/motion/stamps.hpp"

namespace radioslam {
namespace {

Stamp whole_milliseconds(double seconds) {
  return {static_cast<std::int64_t>(std::llround(seconds * kMillisecondsPerSecond)) *
          kNanosecondsPerMillisecond};
}

double detection_probability(double power_dbm, const PhoneParams& params) {
  return 1 / (1 + std::exp((params.threshold_dbm - power_dbm) / params.threshold_softness_db));
}

std::vector<WifiReading> listen(const Eigen::Vector3d& phone, double offset_db,
                                const std::vector<Transmitter>& transmitters, const PhoneParams& params,
                                Rng& rng) {
  std::vector<WifiReading> readings;
  for (std::size_t i = 0; i < transmitters.size(); ++i) {
    const double fading_db = rng.normal(0, params.sigma_fading_db);
    const double chance = rng.uniform();
    const double power_dbm = transmitters[i].mean_power_dbm(phone) + offset_db + fading_db;
    const double reported_dbm = std::round(power_dbm);
    if (reported_dbm < params.floor_dbm || chance >= detection_probability(power_dbm, params)) continue;
    readings.push_back({AccessPointIndex(i), static_cast<float>(transmitters[i].frequency_mhz()),
                        static_cast<float>(reported_dbm)});
  }
  return readings;
}

/// Sorts scans by stamp and delays the later one of equal stamps by a millisecond.
void separate_stamps(std::vector<WifiScan>& scans) {
  std::stable_sort(scans.begin(), scans.end(),
                   [](const WifiScan& a, const WifiScan& b) { return a.stamp < b.stamp; });
  for (std::size_t i = 1; i < scans.size(); ++i)
    scans[i].stamp.ns = std::max(scans[i].stamp.ns, scans[i - 1].stamp.ns + kNanosecondsPerMillisecond);
}

}  // namespace

std::vector<WifiScan> simulate_scans(const PoseAtTime& pose_at, double begin_s, double end_s,
                                     const std::vector<Transmitter>& transmitters, double phone_height_m,
                                     const PhoneParams& params, const Rng& rng) {
  const double period_s = 1 / params.scan_rate_hz;
  std::vector<WifiScan> scans;
  for (int phone = 0; phone < params.phones; ++phone) {
    Rng own = rng.split(static_cast<std::uint64_t>(phone));
    const double offset_db = own.normal(0, params.sigma_phone_offset_db);
    const double first_s = begin_s + period_s * own.uniform();
    for (int k = 0; first_s + k * period_s + params.scan_jitter_s <= end_s; ++k) {
      const Stamp stamp = whole_milliseconds(first_s + k * period_s + params.scan_jitter_s * own.uniform());
      if (own.uniform() < params.missed_scan_ratio) continue;
      const auto position = pose_at(stamp.seconds()).translation();
      auto readings =
          listen({position.x(), position.y(), phone_height_m}, offset_db, transmitters, params, own);
      if (!readings.empty()) scans.push_back({stamp, std::move(readings)});
    }
  }
  separate_stamps(scans);
  return scans;
}

}  // namespace radioslam
