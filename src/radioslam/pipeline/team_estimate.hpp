// What the stages of a run hand on to each other: the team's estimate and what it rests on.
#pragma once

#include <vector>

#include "radioslam/closure/fingerprint_closures.hpp"
#include "radioslam/graph/optimizer.hpp"
#include "radioslam/pipeline/fix_stage.hpp"
#include "radioslam/pipeline/joint_graph.hpp"
#include "radioslam/pipeline/scan_closures.hpp"
#include "radioslam/pipeline/sequence_stage.hpp"
#include "radioslam/pipeline/team_placement.hpp"
#include "radioslam/radio/measurements.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

template <class Pose>
struct TeamEstimate {
  RadioMeasurements radio;
  JointGraph<Pose> joint = {};
  ScanTies scan_ties = {};  ///< of the robots' own scan closures
  TeamFixes<Pose> fixes = {};
  TeamPlacement<Pose> placement = {};
  std::vector<FingerprintClosure> closures = {};
  std::vector<SequenceTie> sequences = {};
  OptimizerSummary solution = {};
  std::vector<ClosureResult> matches = {};  ///< verdicts on the mission's matches
};

}  // namespace radioslam
