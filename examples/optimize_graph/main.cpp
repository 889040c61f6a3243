// Pose graph optimization: a robot drives three sides of a square, then its radio measures the distance to
// its start. Prints the poses with their standard deviations before and after adding that distance.
#include <cstdio>
#include <numbers>
#include <radioslam/graph/marginals.hpp>
#include <radioslam/graph/optimizer.hpp>

using radioslam::PoseId;
using radioslam::SE2;

radioslam::PoseGraph2 drive() {
  radioslam::PoseGraph2 graph;
  const SE2::Tangent sigma(0.2, 0.2, 0.1);  // x, y in metres and yaw in radians, per step
  const SE2 step({5, 0}, std::numbers::pi / 2);
  graph.poses.push_back(SE2());
  for (int i = 0; i < 3; ++i) {
    graph.poses.push_back(graph.poses.back() * step);
    radioslam::RelativePoseFactor<SE2> odometry{PoseId(i), PoseId(i + 1), step};
    odometry.information = sigma.cwiseAbs2().cwiseInverse().asDiagonal();
    graph.relative_poses.push_back(odometry);
  }
  return graph;
}

void print(const char* title, const radioslam::PoseGraph2& graph) {
  std::printf("%s\n", title);
  const auto marginals = radioslam::Marginals<SE2>::compute(graph);
  if (!marginals) return;
  for (std::size_t i = 0; i < graph.poses.size(); ++i) {
    const auto sigma = marginals->pose(PoseId(i)).diagonal().cwiseSqrt().eval();
    const auto& position = graph.poses[i].translation();
    std::printf("  %zu: x %6.3f y %6.3f, sigma %5.3f %5.3f m along and across\n", i, position.x(),
                position.y(), sigma[0], sigma[1]);
  }
}

int main() {
  auto graph = drive();
  print("odometry alone", graph);

  graph.ranges.push_back(
      {.i = {.pose = PoseId(0)}, .j = {.pose = PoseId(3)}, .range_m = 4.6, .sigma_m = 0.1});
  const auto summary = radioslam::optimize(graph, radioslam::OptimizerParams{});
  print("with the distance from the last pose to the first", graph);
  std::printf("cost %.4f after %d iterations\n", summary.final_cost, summary.iterations);
}
