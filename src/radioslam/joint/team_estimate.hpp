// Estimate of a team: the value that the steps of a run take and return.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/closure/fingerprint_closures.hpp"
#include "radioslam/closure/sequence_closures.hpp"
#include "radioslam/graph/optimizer.hpp"
#include "radioslam/joint/closures/closure.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/joint/position_fixes/placement.hpp"
#include "radioslam/joint/team_alignment.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// A list for each origin of closures.
template <class T>
struct ByOrigin {
  std::vector<T> scans = {};  ///< each robot's own, by scan matching; of two, those that do not fit
  std::vector<T> loops = {};  ///< of a graph file, the mission's matches, and those found between robots
  std::vector<T> sequences = {};
};

/// What was measured; no judgement changes it.
struct TeamMeasurements {
  KnownStarts starts = {};  ///< as the mission states them
  ByOrigin<Closure> closures = {};
  std::vector<FingerprintClosure> fingerprint_closures = {};
  std::vector<SequenceClosure> sequences = {};  ///< as matched
};

/// What the estimate says of the measurements.
template <class Pose>
struct TeamJudgement {
  ByOrigin<ClosureJudgement> closures = {};  ///< in the order of the measured ones
  TeamFixes<Pose> fixes = {};                ///< how those of each robot are used
  std::vector<RangeBiasResult> range_biases = {};
  std::optional<LoopChoiceResult> loop_choice = {};
};

template <class Pose>
struct TeamEstimate {
  TeamMeasurements measured = {};
  TeamAlignment<Pose> alignment = {};
  TeamJudgement<Pose> judgement = {};
  JointGraph<Pose> joint = {};
  OptimizerSummary solution = {};
};

}  // namespace radioslam
