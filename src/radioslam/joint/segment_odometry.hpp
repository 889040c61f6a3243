// The odometry along a segment of the joint graph, with covariances, and the kinds of its steps.
#pragma once

#include <algorithm>
#include <vector>

#include "radioslam/consistency/odometry_chain.hpp"
#include "radioslam/joint/joint_graph.hpp"

namespace radioslam {

/// The segment's poses by odometry alone, from the identity. The odometry's standard deviations are taken
/// times `odometry_scale`. Linear in the graph's relative poses.
template <class Pose>
OdometryChain<Pose> odometry_chain(const JointGraph<Pose>& joint, const TrajectorySegment& segment,
                                   double odometry_scale = 1);

/// By relative pose of the graph: whether it is a step of odometry whose stated variances are like those of
/// most, up to a factor of 100. Others are measured in another way, as where wheels alone bridge a gap in the
/// scans: the errors of the ordinary ones do not bear on these.
template <class Pose>
std::vector<bool> ordinary_steps(const JointGraph<Pose>& joint);

/// Actual over stated standard deviation of a step, where that of ordinary ones is `scale`.
inline double scale_of_step(bool is_ordinary, double scale) {
  return is_ordinary ? scale : std::max(1.0, scale);
}

}  // namespace radioslam
