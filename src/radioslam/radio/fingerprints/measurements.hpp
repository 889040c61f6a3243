// Fingerprint measurements of a mission: fingerprints of every robot at their odometry poses, their
// similarities, and the distance models trained on the robots' own odometry. Computed before the team frame
// is known.
//
// As a mission goes on, models and device offsets stay until there are half as many fingerprints again, and
// only new fingerprints are compared. The last one of a robot, not complete yet, is another one later.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/radio/fingerprints/distance_model.hpp"
#include "radioslam/radio/fingerprints/fingerprint.hpp"
#include "radioslam/radio/fingerprints/rssi_offset.hpp"
#include "radioslam/radio/fingerprints/similarity.hpp"
#include "radioslam/radio/fingerprints/team_similarity.hpp"

namespace radioslam {

struct RadioParams {
  FingerprintParams fingerprint;
  SimilarityParams similarity;
  RssiOffsetParams rssi_offset;
  DistanceModelParams distance_model;
  std::string measure = "sorensen";
  std::string layout_measure = "sorensen";

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    FingerprintParams::visit_fields(self.fingerprint, visit);
    SimilarityParams::visit_fields(self.similarity, visit);
    RssiOffsetParams::visit_fields(self.rssi_offset, visit);
    DistanceModelParams::visit_fields(self.distance_model, visit);
    RADIOSLAM_BASIC_FIELD(
        measure, "", 0, 0,
        "similarity measure for fingerprint closures; the default ranks pairs within 5 m best",
        "cosine|gaussian|detection|slide|mended|sorensen");
    RADIOSLAM_FIELD(layout_measure, "", 0, 0,
                    "similarity measure for the layout of the team; the default ranks distant pairs best",
                    "cosine|gaussian|detection|slide|mended|sorensen");
  }
};

/// A fingerprint with the odometry pose at its stamp.
struct PlacedFingerprint {
  Fingerprint fingerprint;  ///< RSSI offset removed
  SE3 T_start_body;         ///< odometry at its stamp
  double travelled_m = 0;   ///< path length from the robot's start
};

/// Fingerprint `index` of robot `robot`.
struct FingerprintIndex {
  RobotIndex robot;
  std::size_t index = 0;
};

/// The team's fingerprints in one list, robot by robot in time order.
struct RadioMeasurements {
  std::vector<std::vector<PlacedFingerprint>> robots;
  std::vector<FingerprintIndex> nodes;  ///< fingerprints of all robots
  TeamSimilarity near_similarity;       ///< over nodes, by `measure`
  TeamSimilarity layout_similarity;     ///< over nodes, by `layout_measure`
  DistanceModel near_model;
  std::optional<MedianModel> layout_model;      ///< absent with too few training samples
  std::optional<DecayModel> decay_model;        ///< the same samples; absent with too few informative ones
  RssiOffsets rssi_offsets = {};                ///< per robot; already subtracted from its fingerprints
  std::vector<std::string> access_points = {};  ///< names by index, as in the mission
  std::size_t fitted = 0;                       ///< fingerprints that models and offsets were fitted to

  const PlacedFingerprint& at(std::size_t node) const {
    return robots[nodes[node].robot.index()][nodes[node].index];
  }
};

RadioMeasurements measure_radio(const Mission& mission, const RadioParams& params, const Progress& progress);

/// The same when more is known of the mission, by the models and offsets of `before`, whose near similarity
/// is joined. Nothing if it is time to fit them again. `mission`: has the same robots.
std::optional<RadioMeasurements> continue_radio(const RadioMeasurements& before, const Mission& mission,
                                                const RadioParams& params);

/// For every node the number that the same fingerprint had in `before`, measured by the same offsets when
/// less was known of the same robots.
EarlierNumbers earlier_nodes(const RadioMeasurements& radio, const RadioMeasurements& before);

}  // namespace radioslam
