#include "radioslam/pipeline/access_point_stage.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "radioslam/base/parallel.hpp"
#include "radioslam/closure/sequence_window.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMostShown = 12;  // readings of an access point
constexpr double kHalfOfScans = 0.5, kAboutHalf = 0.15;
constexpr std::size_t kLeastHalfHeard = 50;
constexpr double kWeakShare = 0.05;  // of all readings that are weaker than a floor nobody can see

/// What was heard of one access point.
struct HeardAccessPoint {
  std::vector<PlacedReading> readings;
  std::vector<std::size_t> at;  ///< the places of `readings`, ascending
  double strongest_dbm = -std::numeric_limits<double>::infinity();
};

/// What was heard of all, and where somebody listened. Where one is silent follows from that: kept for each,
/// it would grow with access points times places.
struct HeardAccessPoints {
  std::vector<Eigen::Vector2d> places_m;
  std::vector<HeardAccessPoint> each;
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

/// The power that half of the scans hear: the median of readings that about half of them held, or, where
/// scans are too few for that, a weak reading.
double hearing_floor_dbm(const RadioMeasurements& radio) {
  std::vector<double> half_heard, all;
  for (const auto& robot : radio.robots)
    for (const PlacedFingerprint& placed : robot)
      for (const FingerprintEntry& entry : placed.fingerprint.entries) {
        all.push_back(static_cast<double>(entry.rss_dbm));
        if (std::abs(static_cast<double>(entry.detection_rate) - kHalfOfScans) <= kAboutHalf)
          half_heard.push_back(all.back());
      }
  const bool enough = half_heard.size() >= kLeastHalfHeard;
  auto& values = enough ? half_heard : all;
  if (values.empty()) return HeardAlongWays{}.floor_dbm;
  const double share = enough ? kHalfOfScans : kWeakShare;
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

HeardAccessPoints readings_of(const RunResult& result, const Mission& mission, const RadioMeasurements& radio,
                              double least_detection) {
  HeardAccessPoints heard{
      {}, std::vector<HeardAccessPoint>(mission.access_points.size()), hearing_floor_dbm(radio)};
  const std::vector<bool> in = in_first_component(result);
  for (std::size_t node = 0; node < radio.nodes.size(); ++node) {
    const std::size_t robot = radio.nodes[node].robot.index();
    const Fingerprint& fingerprint = radio.at(node).fingerprint;
    const auto pose = result.robots[robot].estimate.at(fingerprint.stamp);
    if (!in[robot] || !pose) continue;
    const Eigen::Vector2d place = pose->translation().head<2>();
    for (const FingerprintEntry& entry : fingerprint.entries) {
      if (static_cast<double>(entry.detection_rate) < least_detection) continue;
      HeardAccessPoint& of = heard.each[entry.access_point.index()];
      const double rss_dbm = static_cast<double>(entry.rss_dbm);
      of.readings.push_back({place, rss_dbm});
      of.at.push_back(heard.places_m.size());
      of.strongest_dbm = std::max(of.strongest_dbm, rss_dbm);
    }
    heard.places_m.push_back(place);
  }
  return heard;
}

/// With the places where it was not heard.
HeardAlongWays along_ways(const HeardAccessPoints& heard, std::size_t access_point) {
  const HeardAccessPoint& of = heard.each[access_point];
  HeardAlongWays along{of.readings, {}, heard.floor_dbm};
  auto there = of.at.begin();
  for (std::size_t place = 0; place < heard.places_m.size(); ++place)
    if (there != of.at.end() && *there == place)
      ++there;
    else
      along.silent_m.push_back(heard.places_m[place]);
  return along;
}

/// The last frequency that each access point was heard on.
std::vector<double> frequencies(const Mission& mission) {
  std::vector<double> mhz(mission.access_points.size(), 0);
  for (const Robot& robot : mission.robots)
    for (const WifiScan& scan : robot.wifi)
      for (const WifiReading& reading : scan.readings)
        mhz[reading.access_point.index()] = static_cast<double>(reading.frequency_mhz);
  return mhz;
}

/// A few readings, evenly chosen from the stronger half: the weak ones say little of a place.
std::vector<Eigen::Vector3d> some_of(std::vector<PlacedReading> readings) {
  std::stable_sort(readings.begin(), readings.end(),
                   [](const PlacedReading& a, const PlacedReading& b) { return a.rss_dbm > b.rss_dbm; });
  const std::size_t half = std::min(readings.size(), std::max(kMostShown, readings.size() / 2));
  const std::size_t stride = (half + kMostShown - 1) / kMostShown;
  std::vector<Eigen::Vector3d> some;
  for (std::size_t k = 0; k < half; k += stride)
    some.emplace_back(readings[k].place_m.x(), readings[k].place_m.y(), readings[k].rss_dbm);
  return some;
}

AccessPointKnown known(AccessPointStatus status) {
  switch (status) {
    case AccessPointStatus::kFound:
      return AccessPointKnown::kFound;
    case AccessPointStatus::kAmbiguous:
      return AccessPointKnown::kAmbiguous;
    case AccessPointStatus::kLoose:
      return AccessPointKnown::kLoose;
  }
  return AccessPointKnown::kLoose;
}

void place_access_points(RunResult& result, const Mission& mission, const HeardAccessPoints& heard,
                         const AccessPointParams& params) {
  std::vector<std::optional<AccessPointFit>> fits(heard.each.size());
  parallel_for(fits.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t a = begin; a < end; ++a)
      if (heard.each[a].readings.size() >= static_cast<std::size_t>(params.least_places))
        fits[a] = fit_access_point(along_ways(heard, a), params);
  });
  const std::vector<double> mhz = frequencies(mission);
  for (std::size_t a = 0; a < fits.size(); ++a)
    if (const auto& fit = fits[a])
      result.access_points.push_back({mission.access_points[a], mhz[a], known(fit->status), fit->position_m,
                                      fit->path_loss.power_at_1m_dbm, fit->path_loss.exponent,
                                      fit->covariance, fit->sigma_db, heard.each[a].readings.size(),
                                      fit->rival_m, some_of(heard.each[a].readings)});
  const auto count = [&](AccessPointKnown of) {
    return static_cast<double>(std::count_if(result.access_points.begin(), result.access_points.end(),
                                             [&](const auto& point) { return point.known == of; }));
  };
  result.counts["access_points"] = static_cast<double>(result.access_points.size());
  result.counts["access_points_found"] = count(AccessPointKnown::kFound);
  result.counts["access_points_ambiguous"] = count(AccessPointKnown::kAmbiguous);
}

/// The access points with the strongest readings, the strongest first.
std::vector<std::size_t> strongest(const std::vector<HeardAccessPoint>& heard, std::size_t most) {
  std::vector<std::size_t> order;
  for (std::size_t a = 0; a < heard.size(); ++a)
    if (!heard[a].readings.empty()) order.push_back(a);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return heard[a].strongest_dbm > heard[b].strongest_dbm;
  });
  order.resize(std::min(order.size(), most));
  return order;
}

void tell_signals(RunResult& result, const Mission& mission, const RadioMeasurements& radio,
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

/// The fingerprint in the middle of a robot's way against all of its others.
void tell_similarity(RunResult& result, const Mission& mission, const RadioMeasurements& radio) {
  std::size_t first = 0;
  for (std::size_t r = 0; r < radio.robots.size(); ++r) {
    const std::size_t count = radio.robots[r].size();
    if (count > 1) {
      const std::size_t middle = first + count / 2;
      SimilarityOverTime over{mission.robots[r].id, radio.at(middle).fingerprint.stamp, {}, {}};
      for (std::size_t node = first; node < first + count; ++node) {
        if (node == middle) continue;
        over.stamps.push_back(radio.at(node).fingerprint.stamp);
        over.similarity.push_back(static_cast<float>(similarity_of(radio, middle, node)));
      }
      result.similarity_over_time.push_back(std::move(over));
    }
    first += count;
  }
}

}  // namespace

void add_access_points(RunResult& result, const Mission& mission, const RadioMeasurements& radio,
                       const AccessPointStageParams& params) {
  if (!params.enabled || radio.nodes.empty()) return;
  const auto heard = readings_of(result, mission, radio, params.least_detection);
  place_access_points(result, mission, heard, params.fit);
  tell_signals(result, mission, radio, strongest(heard.each, static_cast<std::size_t>(params.signals)));
  tell_similarity(result, mission, radio);
}

}  // namespace radioslam
