// The values of a team's graph, whose segments may be placed only in part, with the evidence for them.
#pragma once

#include <vector>

#include "radioslam/graph/pose_graph.hpp"

namespace radioslam {

template <class Pose>
struct TeamValues {
  std::vector<Pose> poses;
  std::vector<typename Pose::Point> points;
  std::vector<Drift> drifts;
  double log_evidence = 0;

  void read_from(const PoseGraph<Pose>& graph) {
    poses = graph.poses;
    points = graph.points;
    drifts = graph.drifts;
  }
  void write_to(PoseGraph<Pose>& graph) const {
    graph.poses = poses;
    graph.points = points;
    graph.drifts = drifts;
  }
};

}  // namespace radioslam
