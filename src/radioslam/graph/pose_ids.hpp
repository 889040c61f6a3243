// Visits the ids of the poses that factors are about, so that poses can get new ids.
#pragma once

#include <vector>

#include "radioslam/graph/pose_graph.hpp"

namespace radioslam {

/// Calls `visit` with the id; with that of a range's end if it is a pose.
template <class Visitor>
void visit_pose_id(PoseId& id, const Visitor& visit) {
  if (id.valid()) visit(id);
}
template <class Pose, class Visitor>
void visit_pose_id(RangeEnd<Pose>& end, const Visitor& visit) {
  visit_pose_id(end.pose, visit);
}

/// Calls `visit` with a reference to the id of every pose of the factors, each with one end or two.
template <class Factor, class Visitor>
void for_each_pose_id(std::vector<Factor>& factors, const Visitor& visit) {
  for (Factor& factor : factors) {
    visit_pose_id(factor.i, visit);
    if constexpr (requires { factor.j; }) visit_pose_id(factor.j, visit);
  }
}

/// The same for all factors of a graph.
template <class Pose, class Visitor>
void for_each_pose_id(PoseGraph<Pose>& graph, const Visitor& visit) {
  for_each_pose_id(graph.relative_poses, visit);
  for_each_pose_id(graph.ranges, visit);
  for_each_pose_id(graph.bearings, visit);
  for_each_pose_id(graph.relative_points, visit);
  for_each_pose_id(graph.positions, visit);
  for_each_pose_id(graph.pose_priors, visit);
}

}  // namespace radioslam
