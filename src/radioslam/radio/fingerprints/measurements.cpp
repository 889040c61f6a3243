#include "radioslam/radio/fingerprints/measurements.hpp"

#include <utility>

#include "radioslam/base/check.hpp"
#include "radioslam/mission/odometry_edge.hpp"

namespace radioslam {
namespace {

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

}  // namespace

RadioMeasurements measure_radio(const Mission& mission, const RadioParams& params, const Progress& progress) {
  RadioMeasurements radio{{}, {}, {}, {}, DistanceModel({}, params.distance_model), {}, {}, {}};
  std::vector<std::vector<Fingerprint>> heard;
  for (const Robot& robot : mission.robots) heard.push_back(make_fingerprints(robot, params.fingerprint));
  radio.rssi_offsets = estimate_rssi_offsets(heard, params.similarity, params.rssi_offset);
  std::vector<Fingerprint> all;
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    report_progress(progress, "radio", static_cast<double>(r) / static_cast<double>(mission.robots.size()));
    remove_rssi_offset(heard[r], radio.rssi_offsets.robots[r].offset_db);
    radio.robots.push_back(place_on_odometry(mission.robots[r], std::move(heard[r])));
    for (std::size_t i = 0; i < radio.robots.back().size(); ++i) {
      radio.nodes.push_back({RobotIndex(r), i});
      all.push_back(radio.robots.back()[i].fingerprint);
    }
  }
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

}  // namespace radioslam
