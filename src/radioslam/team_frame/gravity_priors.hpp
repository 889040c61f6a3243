// Priors that constrain a pose's tilt with respect to gravity but not its heading.
#pragma once

#include "radioslam/graph/pose_graph.hpp"

namespace radioslam {

/// Rotates such priors about the vertical to the current heading of their pose; at a large heading difference
/// the residual's tangent would mix heading with tilt. Priors that constrain the heading, and all priors in
/// the plane, are unchanged.
template <class Pose>
void rotate_gravity_priors(PoseGraph<Pose>& graph);
template <>
void rotate_gravity_priors(PoseGraph<SE2>& graph);
template <>
void rotate_gravity_priors(PoseGraph<SE3>& graph);

}  // namespace radioslam
