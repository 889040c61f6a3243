// Stated uncertainty of positions: RobotResult::sigma_position_m relative to what holds the frame,
// sigma_team_m in the gauge of the team.
//
// The marginal covariances are those of one alignment whose accepted evidence is right. Likely alternatives
// widen sigma_team_m by the spread of the mixture of all. Where most closures were rejected, both are widened
// by the factor by which the residuals of distances and angles there exceed what is stated.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "radioslam/graph/marginals.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/joint/team_alignment.hpp"
#include "radioslam/mission/continuous_trajectory.hpp"
#include "radioslam/results/results.hpp"
#include "radioslam/team_frame/measurement_mixture.hpp"

namespace radioslam {

// Notes on robots whose radio links are nearly all obstructed: their place rests on detours.

/// One note for each placed robot of unknown start that has links with other robots, hardly any of them
/// accepted, and no other closure with another robot.
std::vector<std::string> notes_on_obstructed_robots(const std::vector<RobotResult>& robots,
                                                    const std::vector<ClosureResult>& closures);

// Stretches of a robot's trajectory whose evidence was mostly rejected.
//
// Every closure and link of a robot counts at its keyframe: the log likelihood ratio of its status where 95
// % are rejected to the share rejected over the whole mission, by kind. Kinds that are mostly rejected anyway
// (aliased matches, links round corners) say nothing about one stretch. The stretches are the disjoint
// intervals of largest sums, as in a scan statistic, of at least half a minute.

/// Per robot, in time order: first and last keyframe of each stretch.
std::vector<std::vector<std::pair<Stamp, Stamp>>> rejected_stretches(
    std::size_t robots, const std::vector<ClosureResult>& closures);

// Joint graph with factor weights suited for covariances.
//
// For the estimate, links that may be outliers are weighted by their probability of being direct; covariances
// use the smaller observed information (team_frame/measurement_mixture.hpp).

/// Copy of the graph with those weights.
template <class Pose>
JointGraph<Pose> graph_for_covariances(const JointGraph<Pose>& joint, const MixtureParams& mixture);

/// From the marginal covariances. The gauge is that of the robots of each component.
template <class Pose>
void add_uncertainty(std::vector<RobotResult>& robots, const JointGraph<Pose>& joint,
                     const TeamAlignment<Pose>& alignment, const Marginals<Pose>& marginals);

/// Adds the squared distances to the alternatives, by weight, to sigma_team_m.
template <class Pose>
void widen_by_alternatives(std::vector<RobotResult>& robots, const JointGraph<Pose>& joint,
                           const TeamAlignment<Pose>& alignment);

/// In the robots' uncertain stretches.
void widen_by_rejected_closures(std::vector<RobotResult>& robots, const std::vector<ClosureResult>& closures);

// Estimated trajectory of a robot between its keyframes: at every odometry sample, or at given stamps.
//
// The odometry is interpolated between all of the robot's poses in the joint graph
// (continuous_trajectory.hpp), which spreads the corrections by closures, ranges and angles along the whole
// trajectory.

/// In the frame of RobotResult::estimate.
struct DenseTrajectory {
  std::string id;
  Trajectory<SE3> poses;                 ///< T_frame_body
  std::vector<double> sigma_position_m;  ///< sqrt of the mean variance per axis; empty without marginals
};

/// Trajectory of robot `robot` of the joint graph, for queries at any time between its first and last pose
/// there; nothing without odometry or poses. Poses are in the frame of `estimate`, which has the same
/// keyframes. Keeps a reference to `mission`. Without marginals, covariances are relative to the graph's
/// poses. Cost: joint marginal covariances of successive poses.
template <class Pose>
std::optional<ContinuousTrajectory<Pose>> continuous_trajectory(const Mission& mission,
                                                                const JointGraph<Pose>& joint,
                                                                const Marginals<Pose>* marginals,
                                                                std::size_t robot,
                                                                const RobotResult& estimate);

/// At those of the increasing `stamps` that lie between the robot's first and last pose. In the plane,
/// heights are taken from the odometry. Empty without odometry.
template <class Pose>
DenseTrajectory dense_trajectory(const Mission& mission, const JointGraph<Pose>& joint,
                                 const Marginals<Pose>* marginals, std::size_t robot,
                                 const RobotResult& estimate, const std::vector<Stamp>& stamps);

/// At every odometry sample.
template <class Pose>
DenseTrajectory dense_trajectory(const Mission& mission, const JointGraph<Pose>& joint,
                                 const Marginals<Pose>* marginals, std::size_t robot,
                                 const RobotResult& estimate);

}  // namespace radioslam
