// Estimated trajectory of a robot between its keyframes: at every odometry sample, or at given stamps.
//
// The odometry is interpolated between all of the robot's poses in the joint graph
// (continuous_trajectory.hpp), which spreads the corrections by closures, ranges and angles along the whole
// trajectory.
#pragma once

#include <string>
#include <vector>

#include "radioslam/graph/marginals.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/mission/continuous_trajectory.hpp"

namespace radioslam {

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

/// `dense`, with a pose more at every row of `path` between two of its own: the path from one to the next,
/// with what it misses there spread evenly in time. `path`: a finer odometry, which covers the times of
/// `dense`.
template <class Pose>
Trajectory<SE3> along_path(const Trajectory<SE3>& dense, const Trajectory<SE3>& path);

}  // namespace radioslam
