#include "radioslam/radio/measurements.hpp"

#include <utility>

#include "radioslam/base/check.hpp"
#include "radioslam/mission/odometry_edge.hpp"

namespace radioslam {
namespace {

std::vector<PlacedFingerprint> place_on_odometry(const Robot& robot, std::vector<Fingerprint> fingerprints) {
  const std::vector<double> walked = distance_walked(robot.odometry);
  std::vector<PlacedFingerprint> placed;
  for (Fingerprint& fingerprint : fingerprints) {
    const Stamp stamp = fingerprint.stamp;
    placed.push_back({std::move(fingerprint), *robot.odometry.at(stamp),
                      distance_walked_at(robot.odometry, walked, stamp)});
  }
  return placed;
}

/// Pairs of one robot's fingerprints whose odometry distance can be trusted.
std::vector<DistanceSample> training_samples(const RadioMeasurements& radio, const TeamSimilarity& similarity,
                                             double trusted_way_m) {
  std::vector<DistanceSample> samples;
  for (std::size_t i = 0; i < radio.nodes.size(); ++i) {
    for (std::size_t j = i + 1; j < radio.nodes.size(); ++j) {
      if (radio.nodes[j].robot != radio.nodes[i].robot) break;
      const PlacedFingerprint &a = radio.at(i), &b = radio.at(j);
      if (b.walked_m - a.walked_m > trusted_way_m) break;
      const double distance = (b.T_start_body.translation() - a.T_start_body.translation()).norm();
      samples.push_back({static_cast<double>(similarity.of(i, j)), distance});
    }
  }
  return samples;
}

SimilarityMeasure named(const std::string& name) {
  const auto measure = similarity_measure(name);
  RADIOSLAM_CHECK(measure.has_value(), "the measure's name is checked where parameters are read");
  return *measure;
}

}  // namespace

RadioMeasurements measure_radio(const Mission& mission, const RadioParams& params, const Progress& progress) {
  RadioMeasurements radio{{}, {}, {}, {}, DistanceModel({}, params.distance_model), {}, {}};
  std::vector<std::vector<Fingerprint>> heard;
  for (const Robot& robot : mission.robots) heard.push_back(make_fingerprints(robot, params.fingerprint));
  radio.device_offsets = estimate_device_offsets(heard, params.similarity, params.device_offset);
  std::vector<Fingerprint> all;
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    report_progress(progress, "radio", static_cast<double>(r) / static_cast<double>(mission.robots.size()));
    remove_device_offset(heard[r], radio.device_offsets.robots[r].offset_db);
    radio.robots.push_back(place_on_odometry(mission.robots[r], std::move(heard[r])));
    for (std::size_t i = 0; i < radio.robots.back().size(); ++i) {
      radio.nodes.push_back({RobotIndex(r), i});
      all.push_back(radio.robots.back()[i].fingerprint);
    }
  }
  radio.near_similarity = TeamSimilarity(all, named(params.measure), params.similarity);
  radio.layout_similarity = params.layout_measure == params.measure
                                ? radio.near_similarity
                                : TeamSimilarity(all, named(params.layout_measure), params.similarity);

  const double trusted = params.distance_model.trusted_way_m;
  radio.near_model =
      DistanceModel(training_samples(radio, radio.near_similarity, trusted), params.distance_model);
  radio.layout_model = fit_decay(training_samples(radio, radio.layout_similarity, trusted),
                                 params.distance_model.minimum_samples);
  return radio;
}

}  // namespace radioslam
