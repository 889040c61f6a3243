#include "radioslam/graph/spanning_tree.hpp"

#include "radioslam/graph/relative_pose_network.hpp"

namespace radioslam {

template <class Pose>
void initialise_from_spanning_tree(PoseGraph<Pose>& graph) {
  for (const auto& [pose, from, factor] : breadth_first_tree(graph)) {
    if (pose == from) continue;
    const auto& f = graph.relative_poses[factor];
    const bool forward = f.i.index() == from;
    graph.poses[pose] = graph.poses[from] * (forward ? f.T_i_j : f.T_i_j.inverse());
  }
}

template void initialise_from_spanning_tree(PoseGraph<SE2>&);
template void initialise_from_spanning_tree(PoseGraph<SE3>&);

}  // namespace radioslam
