#include "radioslam/radio/fingerprints/measurements.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "radioslam/base/check.hpp"
#include "radioslam/mission/odometry_edge.hpp"

namespace radioslam {
namespace {

constexpr double kRefitGrowth = 1.5;  // of the number of fingerprints

std::vector<PlacedFingerprint> place_on_odometry(const Robot& robot, std::vector<Fingerprint> fingerprints) {
  const std::vector<double> travelled = travelled_distance(robot.odometry);
  std::vector<PlacedFingerprint> placed;
  for (Fingerprint& fingerprint : fingerprints) {
    const Stamp stamp = fingerprint.stamp;
    placed.push_back({std::move(fingerprint), *robot.odometry.at(stamp),
                      travelled_distance_at(robot.odometry, travelled, stamp)});
  }
  return placed;
}

/// Similarity and distance of pairs of one robot's fingerprints whose odometry distance is accurate.
std::vector<DistanceSample> training_samples(const RadioMeasurements& radio, const TeamSimilarity& similarity,
                                             double max_trusted_path_m) {
  std::vector<DistanceSample> samples;
  for (std::size_t i = 0; i < radio.nodes.size(); ++i) {
    for (std::size_t j = i + 1; j < radio.nodes.size(); ++j) {
      if (radio.nodes[j].robot != radio.nodes[i].robot) break;
      const PlacedFingerprint &a = radio.at(i), &b = radio.at(j);
      if (b.travelled_m - a.travelled_m > max_trusted_path_m) break;
      const double distance = (b.T_start_body.translation() - a.T_start_body.translation()).norm();
      samples.push_back({static_cast<double>(similarity.of(i, j)), distance});
    }
  }
  return samples;
}

SimilarityMeasure named(const std::string& name) {
  const auto measure = similarity_measure(name);
  RADIOSLAM_CHECK(measure.has_value(), "the measure's name was validated when the parameters were read");
  return *measure;
}

std::vector<std::vector<Fingerprint>> heard_by_robots(const Mission& mission,
                                                      const FingerprintParams& params) {
  std::vector<std::vector<Fingerprint>> heard;
  for (const Robot& robot : mission.robots) heard.push_back(make_fingerprints(robot, params));
  return heard;
}

/// Adds what the next robot heard, its offset removed, to its measurements and to `all` nodes.
void add_robot(const Robot& robot, std::vector<Fingerprint> heard, RadioMeasurements& radio,
               std::vector<Fingerprint>& all) {
  const std::size_t r = radio.robots.size();
  remove_rssi_offset(heard, radio.rssi_offsets.robots[r].offset_db);
  radio.robots.push_back(place_on_odometry(robot, std::move(heard)));
  for (std::size_t i = 0; i < radio.robots.back().size(); ++i) {
    radio.nodes.push_back({RobotIndex(r), i});
    all.push_back(radio.robots.back()[i].fingerprint);
  }
}

/// For each of the access points of an earlier time its index by now, which rises; the number of them where
/// it is not known.
std::vector<std::size_t> indices_by_now(const std::vector<std::string>& before,
                                        const std::vector<std::string>& now) {
  std::vector<std::size_t> indices;
  std::size_t next = 0;
  for (const std::string& name : before) {
    const auto found = std::find(now.begin() + static_cast<std::ptrdiff_t>(next), now.end(), name);
    indices.push_back(static_cast<std::size_t>(found - now.begin()));
    if (found != now.end()) next = indices.back() + 1;
  }
  return indices;
}

/// Whether they heard the same; `indices`: of access points now.
bool are_same(const Fingerprint& before, const Fingerprint& now, const std::vector<std::size_t>& indices) {
  return before.stamp == now.stamp && before.scans == now.scans &&
         std::equal(before.entries.begin(), before.entries.end(), now.entries.begin(), now.entries.end(),
                    [&](const FingerprintEntry& a, const FingerprintEntry& b) {
                      return indices[a.access_point.index()] == b.access_point.index() &&
                             a.rss_dbm == b.rss_dbm && a.detection_rate == b.detection_rate;
                    });
}

}  // namespace

RadioMeasurements measure_radio(const Mission& mission, const RadioParams& params, const Progress& progress) {
  RadioMeasurements radio{{}, {}, {}, {}, DistanceModel({}, params.distance_model), {}, {}, {}};
  auto heard = heard_by_robots(mission, params.fingerprint);
  radio.rssi_offsets = estimate_rssi_offsets(heard, params.similarity, params.rssi_offset);
  std::vector<Fingerprint> all;
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    report_progress(progress, "radio", static_cast<double>(r) / static_cast<double>(mission.robots.size()));
    add_robot(mission.robots[r], std::move(heard[r]), radio, all);
  }
  radio.access_points = mission.access_points;
  radio.fitted = all.size();
  const SimilarityMeasure near = named(params.measure), layout = named(params.layout_measure);
  radio.near_similarity = TeamSimilarity(all, near, params.similarity);
  radio.layout_similarity =
      layout == near ? radio.near_similarity : TeamSimilarity(all, layout, params.similarity);

  const double trusted = params.distance_model.max_trusted_path_m;
  radio.near_model =
      DistanceModel(training_samples(radio, radio.near_similarity, trusted), params.distance_model);
  auto samples = training_samples(radio, radio.layout_similarity, trusted);
  radio.decay_model = fit_decay(samples, params.distance_model.min_samples);
  radio.layout_model = MedianModel::fit(std::move(samples), params.distance_model.min_samples);
  return radio;
}

std::optional<RadioMeasurements> continue_radio(const RadioMeasurements& before, const Mission& mission,
                                                const RadioParams& params) {
  auto heard = heard_by_robots(mission, params.fingerprint);
  std::size_t count = 0;
  for (const auto& of : heard) count += of.size();
  if (static_cast<double>(count) > kRefitGrowth * static_cast<double>(before.fitted)) return std::nullopt;
  RadioMeasurements radio{{},
                          {},
                          {},
                          {},
                          before.near_model,
                          before.layout_model,
                          before.decay_model,
                          before.rssi_offsets,
                          mission.access_points,
                          before.fitted};
  std::vector<Fingerprint> all;
  for (std::size_t r = 0; r < mission.robots.size(); ++r)
    add_robot(mission.robots[r], std::move(heard[r]), radio, all);
  const SimilarityMeasure near = named(params.measure), layout = named(params.layout_measure);
  radio.near_similarity = before.near_similarity.grown(all, earlier_nodes(radio, before));
  radio.layout_similarity =
      layout == near ? radio.near_similarity : TeamSimilarity(std::move(all), layout, params.similarity);
  return radio;
}

EarlierNumbers earlier_nodes(const RadioMeasurements& radio, const RadioMeasurements& before) {
  const auto indices = indices_by_now(before.access_points, radio.access_points);
  EarlierNumbers earlier(radio.nodes.size());
  std::size_t old = 0;
  for (std::size_t n = 0; n < radio.nodes.size(); ++n) {
    const auto is_before = [&](std::size_t k) {
      return std::tuple(before.nodes[k].robot, before.at(k).fingerprint.stamp) <
             std::tuple(radio.nodes[n].robot, radio.at(n).fingerprint.stamp);
    };
    while (old < before.nodes.size() && is_before(old)) ++old;
    if (old < before.nodes.size() && before.nodes[old].robot == radio.nodes[n].robot &&
        are_same(before.at(old).fingerprint, radio.at(n).fingerprint, indices))
      earlier[n] = old++;
  }
  return earlier;
}

}  // namespace radioslam
