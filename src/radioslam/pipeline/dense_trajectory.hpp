// A robot's estimated trajectory at times between its keyframes: at every row of its odometry, or at any
// others (continuous_trajectory.hpp), between all poses that it has in the joint graph. What closures, ranges
// and angles moved is so spread over the whole way.
#pragma once

#include <string>
#include <vector>

#include "radioslam/graph/marginals.hpp"
#include "radioslam/mission/continuous_trajectory.hpp"
#include "radioslam/pipeline/joint_graph.hpp"

namespace radioslam {

/// In the frame of RobotResult::estimate.
struct DenseTrajectory {
  std::string id;
  Trajectory<SE3> poses;                 ///< T_frame_body
  std::vector<double> sigma_position_m;  ///< sqrt of the mean variance per axis; empty without marginals
};

/// Robot `robot` of the joint graph, ready to be asked at any time between its first and its last pose there;
/// nothing without odometry or without poses. Poses are in the frame of `estimate`, which has the same
/// keyframes. `mission` must stay. Without marginals the covariances are relative to the graph's poses. Cost:
/// the marginals' joint covariances of successive poses.
template <class Pose>
std::optional<ContinuousTrajectory<Pose>> continuous_trajectory(const Mission& mission,
                                                                const JointGraph<Pose>& joint,
                                                                const Marginals<Pose>* marginals,
                                                                std::size_t robot,
                                                                const RobotResult& estimate);

/// At those of the times, increasing, that lie between the robot's first and last pose; heights in the plane
/// are the odometry's. Empty without odometry.
template <class Pose>
DenseTrajectory dense_trajectory(const Mission& mission, const JointGraph<Pose>& joint,
                                 const Marginals<Pose>* marginals, std::size_t robot,
                                 const RobotResult& estimate, const std::vector<Stamp>& stamps);

/// At every row of the odometry.
template <class Pose>
DenseTrajectory dense_trajectory(const Mission& mission, const JointGraph<Pose>& joint,
                                 const Marginals<Pose>* marginals, std::size_t robot,
                                 const RobotResult& estimate);

}  // namespace radioslam
