#include "radioslam/joint/access_point_stage.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "radioslam/base/parallel.hpp"
#include "radioslam/closure/sequence_window.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMaxShown = 400;            // readings shown per access point
constexpr std::size_t kMaxSimilarityStamps = 16;  // fingerprints whose similarity is shown, per robot
constexpr double kHalfOfScans = 0.5, kAboutHalf = 0.15;
constexpr std::size_t kMinHalfDetected = 50;
constexpr double kWeakRatio = 0.05;  // quantile of all readings that serves as a weak reading

/// The readings of one access point.
struct AccessPointReadings {
  std::vector<PlacedReading> readings;
  std::vector<std::size_t> at;  ///< indices into sites_m, ascending
  double strongest_dbm = -std::numeric_limits<double>::infinity();
};

/// The readings of all access points, and the sites of all fingerprints. Sites where an access point was not
/// detected follow from both; storing them for each would cost access points times sites.
struct AllReadings {
  std::vector<Eigen::Vector2d> sites_m;
  std::vector<AccessPointReadings> each;
  double floor_dbm = 0;
};

/// Robots whose estimate is in the first component's frame.
std::vector<bool> in_first_component(const RunResult& result) {
  std::vector<bool> in;
  for (const RobotResult& robot : result.robots) {
    const auto& first = result.components.front().robots;
    in.push_back(robot.placed && std::find(first.begin(), first.end(), robot.id) != first.end());
  }
  return in;
}

/// Power detected in half of the scans: the median of readings that about half of their scans contained, or a
/// weak reading if there are too few of these.
double hearing_floor_dbm(const RadioMeasurements& radio) {
  std::vector<double> half_detected, all;
  for (const auto& robot : radio.robots)
    for (const PlacedFingerprint& placed : robot)
      for (const FingerprintEntry& entry : placed.fingerprint.entries) {
        all.push_back(static_cast<double>(entry.rss_dbm));
        if (std::abs(static_cast<double>(entry.detection_rate) - kHalfOfScans) <= kAboutHalf)
          half_detected.push_back(all.back());
      }
  const bool enough = half_detected.size() >= kMinHalfDetected;
  auto& values = enough ? half_detected : all;
  if (values.empty()) return RssAlongPath{}.floor_dbm;
  const double quantile = enough ? kHalfOfScans : kWeakRatio;
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(quantile * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

AllReadings readings_of(const RunResult& result, const Mission& mission, const RadioMeasurements& radio,
                        double min_detection) {
  AllReadings received{
      {}, std::vector<AccessPointReadings>(mission.access_points.size()), hearing_floor_dbm(radio)};
  const std::vector<bool> in = in_first_component(result);
  for (std::size_t node = 0; node < radio.nodes.size(); ++node) {
    const std::size_t robot = radio.nodes[node].robot.index();
    const Fingerprint& fingerprint = radio.at(node).fingerprint;
    const auto pose = result.robots[robot].estimate.at(fingerprint.stamp);
    if (!in[robot] || !pose) continue;
    const Eigen::Vector2d site = pose->translation().head<2>();
    for (const FingerprintEntry& entry : fingerprint.entries) {
      if (static_cast<double>(entry.detection_rate) < min_detection) continue;
      AccessPointReadings& of = received.each[entry.access_point.index()];
      const double rss_dbm = static_cast<double>(entry.rss_dbm);
      of.readings.push_back({site, rss_dbm});
      of.at.push_back(received.sites_m.size());
      of.strongest_dbm = std::max(of.strongest_dbm, rss_dbm);
    }
    received.sites_m.push_back(site);
  }
  return received;
}

/// Readings of an access point, with the sites where it was not detected.
RssAlongPath along_path(const AllReadings& received, std::size_t access_point) {
  const AccessPointReadings& of = received.each[access_point];
  RssAlongPath along{of.readings, {}, received.floor_dbm};
  auto there = of.at.begin();
  for (std::size_t site = 0; site < received.sites_m.size(); ++site)
    if (there != of.at.end() && *there == site)
      ++there;
    else
      along.undetected_m.push_back(received.sites_m[site]);
  return along;
}

/// The last frequency on which each access point was received.
std::vector<double> frequencies(const Mission& mission) {
  std::vector<double> mhz(mission.access_points.size(), 0);
  for (const Robot& robot : mission.robots)
    for (const WifiScan& scan : robot.wifi)
      for (const WifiReading& reading : scan.readings)
        mhz[reading.access_point.index()] = static_cast<double>(reading.frequency_mhz);
  return mhz;
}

/// Readings, evenly chosen along the paths.
std::vector<Eigen::Vector3d> some_of(const std::vector<PlacedReading>& readings) {
  std::vector<Eigen::Vector3d> some;
  const std::size_t stride = (readings.size() + kMaxShown - 1) / kMaxShown;
  for (std::size_t k = 0; k < readings.size(); k += stride)
    some.emplace_back(readings[k].place_m.x(), readings[k].place_m.y(), readings[k].rss_dbm);
  return some;
}

void place_access_points(RunResult& result, const Mission& mission, const AllReadings& received,
                         const AccessPointParams& params) {
  std::vector<std::optional<AccessPointFit>> fits(received.each.size());
  parallel_for(fits.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t a = begin; a < end; ++a)
      if (received.each[a].readings.size() >= static_cast<std::size_t>(params.min_places))
        fits[a] = fit_access_point(along_path(received, a), params);
  });
  const std::vector<double> mhz = frequencies(mission);
  for (std::size_t a = 0; a < fits.size(); ++a)
    if (const auto& fit = fits[a])
      result.access_points.push_back({mission.access_points[a], mhz[a], fit->status, fit->position_m,
                                      fit->path_loss.power_at_1m_dbm, fit->path_loss.exponent,
                                      fit->covariance, fit->sigma_db, received.each[a].readings.size(),
                                      fit->alternative_m, some_of(received.each[a].readings)});
  const auto count = [&](AccessPointStatus of) {
    return static_cast<double>(std::count_if(result.access_points.begin(), result.access_points.end(),
                                             [&](const auto& point) { return point.status == of; }));
  };
  result.counts["access_points"] = static_cast<double>(result.access_points.size());
  result.counts["access_points_found"] = count(AccessPointStatus::kFound);
  result.counts["access_points_ambiguous"] = count(AccessPointStatus::kAmbiguous);
}

/// The access points with the strongest readings, strongest first.
std::vector<std::size_t> strongest(const std::vector<AccessPointReadings>& received, std::size_t most) {
  std::vector<std::size_t> order;
  for (std::size_t a = 0; a < received.size(); ++a)
    if (!received[a].readings.empty()) order.push_back(a);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return received[a].strongest_dbm > received[b].strongest_dbm;
  });
  order.resize(std::min(order.size(), most));
  return order;
}

void add_signals(RunResult& result, const Mission& mission, const RadioMeasurements& radio,
                 const std::vector<std::size_t>& access_points) {
  for (std::size_t r = 0; r < radio.robots.size(); ++r)
    for (const std::size_t a : access_points) {
      SignalResult signal{mission.robots[r].id, mission.access_points[a], {}, {}};
      for (const PlacedFingerprint& placed : radio.robots[r])
        for (const FingerprintEntry& entry : placed.fingerprint.entries)
          if (entry.access_point.index() == a) {
            signal.stamps.push_back(placed.fingerprint.stamp);
            signal.rss_dbm.push_back(entry.rss_dbm);
          }
      if (!signal.stamps.empty()) result.signals.push_back(std::move(signal));
    }
}

/// Similarity of one fingerprint of a robot, those of which begin at node `first`, to all its others.
SimilarityOverTime similarity_to_others(const std::string& robot, const RadioMeasurements& radio,
                                        std::size_t first, std::size_t count, std::size_t of) {
  SimilarityOverTime over{robot, radio.at(of).fingerprint.stamp, {}, {}};
  for (std::size_t node = first; node < first + count; ++node) {
    if (node == of) continue;
    over.stamps.push_back(radio.at(node).fingerprint.stamp);
    over.similarity.push_back(static_cast<float>(similarity_of(radio, of, node)));
  }
  return over;
}

/// Similarity of some fingerprints, evenly chosen along each robot's trajectory.
void add_similarity(RunResult& result, const Mission& mission, const RadioMeasurements& radio) {
  std::size_t first = 0;
  for (std::size_t r = 0; r < radio.robots.size(); ++r) {
    const std::size_t count = radio.robots[r].size(), shown = std::min(count, kMaxSimilarityStamps);
    for (std::size_t k = 0; k < shown && count > 1; ++k)
      result.similarity_over_time.push_back(similarity_to_others(mission.robots[r].id, radio, first, count,
                                                                 first + (2 * k + 1) * count / (2 * shown)));
    first += count;
  }
}

}  // namespace

void add_access_points(RunResult& result, const Mission& mission, const RadioMeasurements& radio,
                       const AccessPointStageParams& params) {
  if (!params.enabled || radio.nodes.empty()) return;
  const auto received = readings_of(result, mission, radio, params.min_detection);
  place_access_points(result, mission, received, params.fit);
  add_signals(result, mission, radio, strongest(received.each, static_cast<std::size_t>(params.signals)));
  add_similarity(result, mission, radio);
}

}  // namespace radioslam
