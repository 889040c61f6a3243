// Which directions of a graph no factor observes, and how they are held.
// A connected component moves as a rigid body without changing any relative factor. Per component:
//  - with a fixed pose, nothing is done;
//  - without absolute information (pose priors, positions), its first pose is held where it is;
//  - with absolute information of too low a rank, the unobserved motions of its first pose are penalised
//    in the normal equations' matrix, not in the gradient, which leaves the optimum where it is.
// A range-only component has more freedom than a rigid body's; the optimizer's damping deals with that.
#pragma once

#include <vector>

#include "radioslam/graph/pose_graph.hpp"

namespace radioslam {

/// Connected components over all factors. A component's number is that of its first member in the order
/// poses, points; drifts do not connect.
template <class Pose>
struct Components {
  std::vector<std::int32_t> of_pose, of_point;  ///< index of the component's first member
};
template <class Pose>
Components<Pose> connected_components(const PoseGraph<Pose>& graph);

/// A penalty on one pose's step: xi^T penalty xi.
template <class Pose>
struct GaugePenalty {
  PoseId pose;
  typename Pose::Jacobian penalty;
};

template <class Pose>
struct Gauge {
  std::vector<bool> held;  ///< per pose: fixed by the graph, or held here
  std::vector<GaugePenalty<Pose>> penalties;
};
template <class Pose>
Gauge<Pose> resolve_gauge(const PoseGraph<Pose>& graph);

}  // namespace radioslam
