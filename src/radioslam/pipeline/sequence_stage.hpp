// Sequence closures in the joint graph: windows of fingerprints that match give relative poses between the
// keyframes before their middles. In the plane only.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/closure/sequence_closures.hpp"
#include "radioslam/pipeline/joint_graph.hpp"

namespace radioslam {

struct SequenceStageParams {
  bool enabled = true;
  double loss_sigmas = 2;  ///< scale of the Cauchy loss on a closure
  SequenceClosureParams closure;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"enabled", "", 0, 0, "whether stretches of way that sounded alike become relative poses"},
          self.enabled);
    visit(Field{"closure_loss_sigmas", "", 0.1, 1e6, "scale of the Cauchy loss on such a pose; ours"},
          self.loss_sigmas);
    SequenceClosureParams::visit_fields(self.closure, visit);
  }
};

/// A candidate, and its place in graph.relative_poses if it was accepted.
struct SequenceTie {
  SequenceClosure closure;
  std::size_t factor = 0;
};

/// What to say where none are sought although there are fingerprints: outside the plane.
std::optional<std::string> sequence_note(int dimension, const RadioMeasurements& radio,
                                         const SequenceStageParams& params);

/// Looks for sequence closures and adds those accepted to the graph.
template <class Pose>
std::vector<SequenceTie> add_sequence_closures(JointGraph<Pose>& joint, const RadioMeasurements& radio,
                                               const SequenceStageParams& params);

/// What became of them, the graph optimised; the statistic is the mean residual in metres.
template <class Pose>
std::vector<ClosureResult> collect_sequence_closures(const JointGraph<Pose>& joint,
                                                     const RadioMeasurements& radio,
                                                     const std::vector<SequenceTie>& ties);

}  // namespace radioslam
