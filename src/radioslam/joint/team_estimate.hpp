// Team estimate: the value that the stages of a run take and return, with the measurements it is based on.
#pragma once

#include <vector>

#include "radioslam/closure/fingerprint_closures.hpp"
#include "radioslam/graph/optimizer.hpp"
#include "radioslam/joint/closures/closure.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/joint/position_fixes/placement.hpp"
#include "radioslam/joint/sequence_stage.hpp"
#include "radioslam/joint/team_placement.hpp"
#include "radioslam/radio/fingerprints/measurements.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

template <class Pose>
struct TeamEstimate {
  RadioMeasurements radio;
  JointGraph<Pose> joint = {};
  KnownStarts starts = {};  ///< as the mission states them, or as position fixes determined them
  TeamFixes<Pose> fixes = {};
  TeamPlacement<Pose> placement = {};
  std::vector<Closure> loops = {};  ///< relative poses of a graph file that are not odometry
  std::vector<FingerprintClosure> closures = {};
  std::vector<SequenceClosure> sequences = {};
  OptimizerSummary solution = {};
  std::vector<RangeBiasResult> range_biases = {};
  std::vector<ClosureResult> matches = {};  ///< outcomes of the mission's matches
};

}  // namespace radioslam
