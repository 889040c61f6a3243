// Priors that say how a pose stands to gravity and nothing about its heading.
#pragma once

#include "radioslam/graph/pose_graph.hpp"

namespace radioslam {

/// Turns such priors about the vertical to the heading that their pose has now: far from it, the tangent of
/// the difference would mix heading with tilt. Priors with information about the heading, and the plane's,
/// stay.
template <class Pose>
void turn_level_priors(PoseGraph<Pose>& graph);

}  // namespace radioslam
