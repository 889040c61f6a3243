// The odometry along a segment of the joint graph, with covariances.
#pragma once

#include "radioslam/consistency/odometry_chain.hpp"
#include "radioslam/joint/joint_graph.hpp"

namespace radioslam {

/// The segment's poses by odometry alone, from the identity. The odometry's standard deviations are taken
/// times `odometry_scale`. Linear in the graph's relative poses.
template <class Pose>
OdometryChain<Pose> odometry_chain(const JointGraph<Pose>& joint, const TrajectorySegment& segment,
                                   double odometry_scale = 1);

}  // namespace radioslam
