// Place recognition between robots with laser scans: keyframe pairs are proposed, then verified by scan
// matching; the joint estimate judges what is found (pipeline.hpp).
//
//   propose   For every `stride_m` of one robot's path, keyframes of the other that may be the same place.
//             Where other measurements align the two, these are among the pairs that the overlap search
//             keeps: the best one in each likely alignment, by
//               -d^2 / (2 sigma^2) - D / 0.1,    d, sigma: predicted distance and its standard deviation,
//                                                D: distance of the descriptors (places/scan_context.hpp),
//             which is computed only where it can decide. Without pruning, and for robots that nothing
//             aligns, they are those with the most similar descriptors of all, at most
//             `max_descriptor_distance`.
//   verify    The scan is registered to a submap around the proposed keyframe, all over the uncertainty of
//             the predicted relative pose (places/loops/loop_verification.hpp). A planar scanner sees little
//             from one place: its scan is registered together with those just before and after it.
//
// Once a team was judged, it predicts better, and another round finds more; what was accepted, or tried
// under a prediction that was hardly worse, is not tried again.
//
// Robots whose scanners are of different kinds, in space and in a plane, are not compared.
#pragma once

#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/joint/closures/closure.hpp"
#include "radioslam/joint/places/place_proposals.hpp"
#include "radioslam/odometry/scan_stage.hpp"
#include "radioslam/team_frame/radio_alignment.hpp"

namespace radioslam {

struct RecognisedPlaces {
  std::vector<VerifiedClosure> closures;  ///< every registration
  std::vector<PlaceAttempt> attempts;     ///< the same registrations
  PlaceExchange exchange;
  PlaceCounts counts;

  bool has_verified() const { return counts.verified > 0; }
  void append(RecognisedPlaces more);
  /// Notes which attempts the joint estimate accepted, of all closures that it judged.
  void note_judgement(const std::vector<Closure>& judged, const std::vector<ClosureJudgement>& judgements);
};

/// Whether two robots have scans that can be compared.
bool has_comparable_scans(const MeasuredScans& scans);

/// How many registrations a round gets, from 0 on, `done` before it. Of a budget that is `given`, equal
/// shares of what is left; else as many as in all rounds before, as long as they are worth it; nothing: no
/// bound.
std::optional<VerificationBudget> budget_of_round(const PlaceParams& places,
                                                  std::optional<VerificationBudget> given, std::size_t robots,
                                                  int round, std::size_t done);

template <class Pose>
RecognisedPlaces recognise_places(const PlaceInput<Pose>& input, const PlaceParams& params,
                                  const ScanParams& scan_params, const RadioAlignmentParams& alignment,
                                  const Progress& progress);

}  // namespace radioslam
