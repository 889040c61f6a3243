// Estimate of a team: the value that the steps of a run take and return.
#pragma once

#include <vector>

#include "radioslam/closure/fingerprint_closures.hpp"
#include "radioslam/graph/optimizer.hpp"
#include "radioslam/joint/closures/closure.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/joint/position_fixes/placement.hpp"
#include "radioslam/joint/team_alignment.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// The closures of a team, by origin; measured at first, with their outcomes once they were judged.
struct TeamClosures {
  std::vector<Closure> scans = {};    ///< each robot's own, by scan matching; of two, those that do not fit
  std::vector<Closure> loops = {};    ///< of a graph file, or the matches of a team that stands on them
  std::vector<Closure> matches = {};  ///< the mission's otherwise, if they are asked for
  std::vector<Closure> sequences = {};
  std::vector<FingerprintClosure> fingerprints = {};
};

template <class Pose>
struct TeamEstimate {
  JointGraph<Pose> joint = {};
  KnownStarts starts = {};  ///< as the mission states them, or as position fixes determined them
  TeamFixes<Pose> fixes = {};
  TeamAlignment<Pose> alignment = {};
  TeamClosures closures = {};
  OptimizerSummary solution = {};
  std::vector<RangeBiasResult> range_biases = {};
};

}  // namespace radioslam
