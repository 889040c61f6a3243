// Inlier growth for position fixes: starts from seeds and follows the path, so that fixes near inliers are
// classified first, while the odometry in between is still accurate.
//
// Optimizing with all fixes at once would pull the trajectory towards a run of wrong fixes until it fits
// them. Instead, each round fits the trajectory to the current inliers (Geman-McClure loss); a fix then
// passes if
//   r^2 <= gate (sigma^2 + u^2),   u = max_drift_ratio * path length to the nearest inlier.
// Inliers that do not pass are removed. Fixes that pass are added if u < sigma, or if u <= reach times the
// smallest u of those that pass: a gap in the fixes is crossed from its edge. Ends when the inliers no longer
// change, or after max_rounds. Cost: one optimization of all robots per round.
#pragma once

#include <vector>

#include "radioslam/graph/optimizer.hpp"
#include "radioslam/graph/pose_graph.hpp"
#include "radioslam/team_frame/fix_alignment.hpp"

namespace radioslam {

/// A robot's fixes in temporal order, with their inliers.
template <class Pose>
struct FixInliers {
  std::vector<PositionFactor<Pose>> factors;
  std::vector<FixAlongPath> along_path;  ///< same order as factors
  std::vector<double> seeds_m;           ///< path lengths at which the initial values are right
  std::vector<bool> holds;               ///< is an inlier; initially none is
};

/// Parameters of the growth only.
struct FixGrowthParams {
  double gate = 9.21;             ///< chi-squared
  double max_drift_ratio = 0.03;  ///< odometry drift per path length
  double reach = 1.25;            ///< see above
  int max_rounds = 200;
};

/// Fits graph.poses and drifts to the inliers, and finds these. graph.positions must be empty and is left
/// empty. Initial values must be close to the fixes at every robot's seeds.
template <class Pose>
void grow_inliers(PoseGraph<Pose>& graph, std::vector<FixInliers<Pose>>& team, const FixGrowthParams& params,
                  const OptimizerParams& optimizer);

}  // namespace radioslam
