// Everything the radio says, before anybody's place is known: fingerprints of every robot where its odometry
// saw them, their similarities, and the distance models trained on each robot's own odometry.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/radio/decay_model.hpp"
#include "radioslam/radio/device_offset.hpp"
#include "radioslam/radio/distance_model.hpp"
#include "radioslam/radio/fingerprint.hpp"
#include "radioslam/radio/similarity.hpp"
#include "radioslam/radio/team_similarity.hpp"

namespace radioslam {

struct RadioParams {
  FingerprintParams fingerprint;
  SimilarityParams similarity;
  DeviceOffsetParams device_offset;
  DistanceModelParams distance_model;
  std::string measure = "sorensen";         ///< for near pairs
  std::string layout_measure = "sorensen";  ///< for the layout of the team

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    FingerprintParams::visit_fields(self.fingerprint, visit);
    SimilarityParams::visit_fields(self.similarity, visit);
    DeviceOffsetParams::visit_fields(self.device_offset, visit);
    DistanceModelParams::visit_fields(self.distance_model, visit);
    visit(Field{"measure", "", 0, 0, "similarity that finds near pairs; best ranking of pairs under 5 m",
                "cosine|gaussian|detection|slide|mended|sorensen"},
          self.measure);
    visit(Field{"layout_measure", "", 0, 0, "similarity that lays out the team; best ranking of far pairs",
                "cosine|gaussian|detection|slide|mended|sorensen"},
          self.layout_measure);
  }
};

/// A fingerprint where its robot's odometry was.
struct PlacedFingerprint {
  Fingerprint fingerprint;  ///< without its device's offset
  SE3 T_start_body;         ///< odometry at its stamp
  double walked_m = 0;      ///< from the robot's start
};

/// Fingerprint `index` of robot `robot`.
struct FingerprintIndex {
  RobotIndex robot;
  std::size_t index = 0;
};

/// The team's fingerprints in one list, robot by robot in time order.
struct RadioMeasurements {
  std::vector<std::vector<PlacedFingerprint>> robots;
  std::vector<FingerprintIndex> nodes;  ///< all of them
  TeamSimilarity near_similarity;       ///< of nodes, `measure`
  TeamSimilarity layout_similarity;     ///< of nodes, `layout_measure`
  DistanceModel near_model;
  std::optional<DecayModel> layout_model;  ///< absent when too few samples train it
  DeviceOffsets device_offsets = {};       ///< of each robot; already taken off its fingerprints

  const PlacedFingerprint& at(std::size_t node) const {
    return robots[nodes[node].robot.index()][nodes[node].index];
  }
};

RadioMeasurements measure_radio(const Mission& mission, const RadioParams& params, const Progress& progress);

}  // namespace radioslam
