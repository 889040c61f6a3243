// The values of a graph's variables without its factors: to go back to, or to carry to another graph of the
// same variables.
#pragma once

#include <vector>

#include "radioslam/graph/pose_graph.hpp"

namespace radioslam {

template <class Pose>
struct GraphValues {
  GraphValues() = default;
  explicit GraphValues(const PoseGraph<Pose>& graph)
      : poses(graph.poses), points(graph.points), drifts(graph.drifts), range_biases(graph.range_biases) {}

  void restore(PoseGraph<Pose>& graph) const {
    graph.poses = poses;
    graph.points = points;
    graph.drifts = drifts;
    graph.range_biases = range_biases;
  }

  std::vector<Pose> poses;
  std::vector<typename Pose::Point> points;
  std::vector<Drift> drifts;
  std::vector<double> range_biases;
};

}  // namespace radioslam
