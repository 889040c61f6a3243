// Ranges, angles of arrival and anchors of a mission as parts of the joint graph.
// Angles are levelled by the odometry's roll and pitch where the estimate moves in the plane.
#pragma once

#include <vector>

#include "radioslam/pipeline/joint_graph.hpp"
#include "radioslam/pipeline/robot_nodes.hpp"

namespace radioslam {

/// Adds to every robot's moments the stamps of the links and matches it took part in.
void add_link_moments(const Mission& mission, std::vector<std::vector<Stamp>>& moments);

/// The paths as an estimate of this dimension sees them, given the receiver's odometry pose.
template <class Pose>
ArrivalMeasurement as_estimated(const ArrivalMeasurement& measured, const SE3& T_start_body);

/// Adds points for the anchors, and the links whose moments all their robots' odometries cover; counts the
/// rest.
template <class Pose>
void add_radio_factors(JointGraph<Pose>& joint, const Mission& mission, const std::vector<RobotNodes>& nodes);

}  // namespace radioslam
