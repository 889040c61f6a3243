// Sequence closures in the joint graph: matching windows of fingerprints give relative poses between the
// keyframes before their centres. In the plane only.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/closure/sequence_closures.hpp"
#include "radioslam/joint/closures/closure.hpp"

namespace radioslam {

struct SequenceStageParams {
  bool enabled = true;
  double loss_sigmas = 2;
  SequenceClosureParams closure;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(
        enabled, "", 0, 0,
        "whether similar sequences of fingerprints are added as relative poses (planar estimates only)");
    visit(
        Field{"closure_loss_sigmas", "", 0.1, 1e6,
              "Cauchy loss scale of sequence closures; higher values keep more of them but admit false ones"},
        self.loss_sigmas);
    SequenceClosureParams::visit_fields(self.closure, visit);
  }
};

/// Note for missions with fingerprints where sequence closures are skipped because the estimate is not
/// planar.
std::optional<std::string> sequence_note(int dimension, const RadioMeasurements& radio,
                                         const SequenceStageParams& params);

/// Matches sequences, or none where they are not asked for.
std::vector<SequenceClosure> match_sequences(int dimension, const RadioMeasurements& radio,
                                             const SequenceStageParams& params,
                                             const EarlierSequences* earlier);

/// Chooses among matched sequences, moves them to keyframes, and adds the accepted ones to the graph; returns
/// all. The statistic of those rejected is their mean residual in metres.
template <class Pose>
std::vector<VerifiedClosure> add_sequence_closures(JointGraph<Pose>& joint, const RadioMeasurements& radio,
                                                   const std::vector<SequenceClosure>& matched,
                                                   const SequenceStageParams& params);

}  // namespace radioslam
