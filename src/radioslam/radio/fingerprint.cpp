#include "radioslam/radio/fingerprint.hpp"

#include <functional>
#include <map>

#include "radioslam/mission/odometry_edge.hpp"

namespace radioslam {
namespace {

struct Sum {
  double rss_dbm = 0;
  int scans = 0;
};

Fingerprint merge(const std::vector<const WifiScan*>& window) {
  Fingerprint fingerprint;
  fingerprint.scans = static_cast<int>(window.size());
  std::map<AccessPointIndex, Sum> sums;
  std::int64_t offset_ns = 0;
  for (const WifiScan* scan : window) {
    offset_ns += scan->stamp.ns - window.front()->stamp.ns;
    for (const WifiReading& reading : scan->readings) {
      Sum& sum = sums[reading.access_point];
      sum.rss_dbm += static_cast<double>(reading.rssi_dbm);
      ++sum.scans;
    }
  }
  fingerprint.stamp.ns = window.front()->stamp.ns + offset_ns / fingerprint.scans;
  for (const auto& [access_point, sum] : sums) {
    fingerprint.entries.push_back({access_point, static_cast<float>(sum.rss_dbm / sum.scans),
                                   static_cast<float>(sum.scans) / static_cast<float>(fingerprint.scans)});
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
  const std::vector<double> walked = distance_walked(robot.odometry);
  std::vector<const WifiScan*> covered;
  for (const WifiScan& scan : robot.wifi)
    if (robot.odometry.covers(scan.stamp)) covered.push_back(&scan);
  return group(covered, [&](const WifiScan& first, const WifiScan& next) {
    return seconds_between(first.stamp, next.stamp) < params.window_s &&
           distance_walked_at(robot.odometry, walked, next.stamp) -
                   distance_walked_at(robot.odometry, walked, first.stamp) <
               params.window_way_m;
  });
}

}  // namespace radioslam
