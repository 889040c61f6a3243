#include "radioslam/radio/fingerprints/fingerprint.hpp"

#include <algorithm>
#include <functional>

#include "radioslam/mission/odometry_edge.hpp"

namespace radioslam {
namespace {

/// Readings of all scans ordered by access point, then by scan.
std::vector<const WifiReading*> by_access_point(const std::vector<const WifiScan*>& window) {
  std::vector<const WifiReading*> readings;
  for (const WifiScan* scan : window)
    for (const WifiReading& reading : scan->readings) readings.push_back(&reading);
  const auto before = [](const WifiReading* a, const WifiReading* b) {
    return a->access_point < b->access_point;
  };
  if (!std::is_sorted(readings.begin(), readings.end(), before))
    std::stable_sort(readings.begin(), readings.end(), before);
  return readings;
}

Fingerprint merge(const std::vector<const WifiScan*>& window) {
  Fingerprint fingerprint;
  fingerprint.scans = static_cast<int>(window.size());
  std::int64_t offset_ns = 0;
  for (const WifiScan* scan : window) offset_ns += scan->stamp.ns - window.front()->stamp.ns;
  fingerprint.stamp.ns = window.front()->stamp.ns + offset_ns / fingerprint.scans;
  const auto readings = by_access_point(window);
  for (auto next = readings.begin(); next != readings.end();) {
    const AccessPointIndex access_point = (*next)->access_point;
    double sum_dbm = 0;
    int heard = 0;
    for (; next != readings.end() && (*next)->access_point == access_point; ++next, ++heard)
      sum_dbm += static_cast<double>((*next)->rssi_dbm);
    fingerprint.entries.push_back({access_point, static_cast<float>(sum_dbm / heard),
                                   static_cast<float>(heard) / static_cast<float>(fingerprint.scans)});
  }
  return fingerprint;
}

using SameWindow = std::function<bool(const WifiScan& first, const WifiScan& next)>;

std::vector<Fingerprint> group(const std::vector<const WifiScan*>& scans, const SameWindow& same_window) {
  std::vector<Fingerprint> fingerprints;
  std::vector<const WifiScan*> window;
  for (const WifiScan* scan : scans) {
    if (!window.empty() && !same_window(*window.front(), *scan)) {
      fingerprints.push_back(merge(window));
      window.clear();
    }
    window.push_back(scan);
  }
  if (!window.empty()) fingerprints.push_back(merge(window));
  return fingerprints;
}

}  // namespace

std::vector<Fingerprint> make_fingerprints(const std::vector<WifiScan>& scans,
                                           const FingerprintParams& params) {
  std::vector<const WifiScan*> all;
  for (const WifiScan& scan : scans) all.push_back(&scan);
  return group(all, [&](const WifiScan& first, const WifiScan& next) {
    return seconds_between(first.stamp, next.stamp) < params.window_s;
  });
}

std::vector<Fingerprint> make_fingerprints(const Robot& robot, const FingerprintParams& params) {
  const std::vector<double> travelled = travelled_distance(robot.odometry);
  std::vector<const WifiScan*> covered;
  for (const WifiScan& scan : robot.wifi)
    if (robot.odometry.covers(scan.stamp)) covered.push_back(&scan);
  return group(covered, [&](const WifiScan& first, const WifiScan& next) {
    return seconds_between(first.stamp, next.stamp) < params.window_s &&
           travelled_distance_at(robot.odometry, travelled, next.stamp) -
                   travelled_distance_at(robot.odometry, travelled, first.stamp) <
               params.window_path_m;
  });
}

}  // namespace radioslam
