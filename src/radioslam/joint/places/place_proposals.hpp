// Keyframe pairs of different robots that may have seen the same place (place_recognition.hpp).
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/joint/places/place_exchange.hpp"
#include "radioslam/joint/places/scanned_robot.hpp"
#include "radioslam/joint/places/verification_budget.hpp"
#include "radioslam/joint/team_estimate.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/places/scan_context_index.hpp"
#include "radioslam/results/candidate_list.hpp"
#include "radioslam/team_frame/radio_alignment.hpp"

namespace radioslam {

struct PlaceParams {
  bool enabled = true;
  double stride_m = 0;
  double min_shared_view = 0.18;
  int candidates = 3;
  double submap_m = 10;
  double source_m = 3;
  int rounds = 8;
  int first_round = 8;
  double least_worth = 0.05;
  double max_descriptor_distance = 0.7;
  PlaceDescriptorParams descriptors;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(enabled, "", 0, 1, "whether scans of different robots are compared");
    RADIOSLAM_FIELD(stride_m, "m", 0, 1e4,
                    "path length between keyframes that are compared with another robot's; 0: a fifth of the "
                    "descriptors' range");
    RADIOSLAM_FIELD(
        min_shared_view, "", 0, 1,
        "smallest share of their views that the compared scans have in common; see overlap.min_shared_view");
    RADIOSLAM_FIELD(submap_m, "m", 0, 1e3,
                    "path length to either side of a keyframe that the submap covers to which others are "
                    "registered");
    RADIOSLAM_FIELD(source_m, "m", 0, 1e3,
                    "path length to either side of a keyframe whose scans are registered together, of planar "
                    "scanners; 0: its scan alone");
    RADIOSLAM_FIELD(rounds, "", 1, 100,
                    "largest number of rounds of search and judgement; a round ends with a better "
                    "prediction for the next");
    RADIOSLAM_FIELD(first_round, "", 1, 1e6,
                    "number of keyframes per pair of robots that are registered in the first round, those of "
                    "greatest worth; every round registers twice as many as the one before");
    RADIOSLAM_FIELD(least_worth, "nat", 0, 1e3,
                    "information that a registration must be expected to add, times the probability that it "
                    "holds; 0: all that are proposed are registered at once");
    RADIOSLAM_FIELD(candidates, "", 1, 1000,
                    "largest number of keyframes of another robot that a keyframe is registered to");
    RADIOSLAM_FIELD(max_descriptor_distance, "", 0, 1,
                    "largest distance of two descriptors of the same place, where nothing else aligns the "
                    "robots; DiSCo-SLAM: 0.2");
    PlaceDescriptorParams::visit_fields(self.descriptors, visit);
  }
};

/// How many pairs of keyframes of different robots came how far.
struct PlaceCounts {
  std::size_t pairs = 0;          ///< all, with the strides of one robot
  std::size_t allowed = 0;        ///< of these, left by pruning in the first round
  std::size_t compared = 0;       ///< descriptors compared
  std::size_t proposed = 0;       ///< to be registered
  std::size_t registrations = 0;  ///< of these, within the budget
  std::size_t verified = 0;       ///< registered with success
  PlaceBytes bytes, bytes_all;    ///< sent, over all rounds; if all descriptors and scans were sent

  bool has_left_out() const { return registrations < proposed; }
};

/// A pair of keyframes that was registered.
struct PlaceAttempt {
  RobotIndex robot_i, robot_j;
  std::size_t i = 0, j = 0;  ///< of the robots' scanned keyframes
  double sigma_m = 0;        ///< of the predicted relative position, per axis
  bool holds = false;        ///< accepted by the joint estimate
};

/// What place recognition works on.
template <class Pose>
struct PlaceInput {
  const TeamEstimate<Pose>& team;
  const Mission& mission;
  const MeasuredScans& scans;
  const TeamDescriptors& descriptors;
  /// The pairs of the joint graph's keyframes that may be compared, by robots; null: all, without pruning.
  const std::vector<CandidateList::Group>* allowed = nullptr;
  std::vector<PlaceAttempt> tried = {};           ///< in earlier rounds
  PlaceExchange exchange = {};                    ///< of earlier rounds
  std::optional<VerificationBudget> budget = {};  ///< of this round
};

struct PlaceProposals {
  std::vector<ScannedRobot> robots;  ///< without keyframes where they have no scans
  std::vector<Proposal> pairs;       ///< within the budget, if there is one: the best first
  PlaceExchange exchange;            ///< with the descriptors of this round
  PlaceCounts counts;
};

/// `loops`: what scans are registered by.
template <class Pose>
PlaceProposals propose_places(const PlaceInput<Pose>& input, const PlaceParams& params,
                              const ScanLoopParams& loops, const RadioAlignmentParams& alignment);

}  // namespace radioslam
