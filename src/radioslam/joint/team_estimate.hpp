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
  std::vector<Closure> scans = {};    ///< each robot's own, by scan matching
  std::vector<Closure> loops = {};    ///< of a graph file, or the matches of a team that stands on them
  std::vector<Closure> matches = {};  ///< the mission's otherwise, if they are asked for
  std::vector<Closure> sequences = {};
  std::vector<FingerprintClosure> fingerprints = {};
  OptimizerSummary solution = {};
  std::vector<RangeBiasResult> range_biases = {};
};

}  // namespace radioslam
