#include "radioslam/graph/chordal.hpp"

#include "radioslam/graph/pose_network.hpp"

namespace radioslam {
namespace {

/// The poses that hold the others: the roots of the breadth-first trees.
template <class Pose>
std::vector<bool> held_poses(const PoseGraph<Pose>& graph) {
  std::vector<bool> held(graph.poses.size(), false);
  for (const auto& step : breadth_first_tree(graph))
    if (step.pose == step.from) held[step.pose] = true;
  return held;
}

}  // namespace

template <class Pose>
RelativePoseNetwork relative_pose_network(const PoseGraph<Pose>& graph) {
  RelativePoseNetwork n{std::vector<std::size_t>(graph.poses.size() + 1, 0), {}};
  for (const auto& f : graph.relative_poses) {
    ++n.starts[f.i.index() + 1];
    ++n.starts[f.j.index() + 1];
  }
  for (std::size_t p = 0; p < graph.poses.size(); ++p) n.starts[p + 1] += n.starts[p];
  n.factors.resize(2 * graph.relative_poses.size());
  auto next = n.starts;
  for (std::size_t k = 0; k < graph.relative_poses.size(); ++k) {
    n.factors[next[graph.relative_poses[k].i.index()]++] = k;
    n.factors[next[graph.relative_poses[k].j.index()]++] = k;
  }
  return n;
}

template <class Pose>
std::vector<TreeStep> breadth_first_tree(const PoseGraph<Pose>& graph) {
  const auto network = relative_pose_network(graph);
  std::vector<bool> reached(graph.poses.size(), false);
  std::vector<TreeStep> steps;
  const auto add_root = [&](std::size_t pose) {
    reached[pose] = true;
    steps.push_back({pose, pose, 0});
  };
  std::size_t done = 0;
  const auto spread = [&] {
    for (; done < steps.size(); ++done) {
      const std::size_t pose = steps[done].pose;
      for (std::size_t k = network.starts[pose]; k < network.starts[pose + 1]; ++k) {
        const auto& f = graph.relative_poses[network.factors[k]];
        const std::size_t other = f.i.index() == pose ? f.j.index() : f.i.index();
        if (reached[other]) continue;
        reached[other] = true;
        steps.push_back({other, pose, network.factors[k]});
      }
    }
  };
  for (std::size_t p = 0; p < graph.pose_fixed.size(); ++p)
    if (graph.pose_fixed[p]) add_root(p);
  spread();
  for (std::size_t p = 0; p < graph.poses.size(); ++p)
    if (!reached[p]) {
      add_root(p);
      spread();
    }
  return steps;
}

template RelativePoseNetwork relative_pose_network(const PoseGraph<SE2>&);
template RelativePoseNetwork relative_pose_network(const PoseGraph<SE3>&);
template std::vector<TreeStep> breadth_first_tree(const PoseGraph<SE2>&);
template std::vector<TreeStep> breadth_first_tree(const PoseGraph<SE3>&);

template <class Pose>
ChordalResult initialise_chordal(PoseGraph<Pose>& graph) {
  const auto held = held_poses(graph);
  PoseNetworkSolver<Pose> solver(graph, held);
  PoseMatrices<Pose> start;
  for (const auto& pose : graph.poses) start.push_back(pose.rotation_matrix().transpose());
  if (!solver.set_terms(rotation_terms(graph))) return ChordalResult::kNotPositiveDefinite;
  auto rotations = solver.solve(Pose::kDim, start);
  if (!rotations) return ChordalResult::kNotPositiveDefinite;
  for (auto& r : *rotations) r = nearest_rotation(PoseMatrix<Pose>(r.transpose()));

  for (std::size_t p = 0; p < start.size(); ++p) start[p].col(0) = graph.poses[p].translation();
  if (!solver.set_terms(translation_terms(graph, *rotations))) return ChordalResult::kNotPositiveDefinite;
  const auto positions = solver.solve(1, std::move(start));
  if (!positions) return ChordalResult::kNotPositiveDefinite;
  for (std::size_t p = 0; p < held.size(); ++p)
    if (!held[p]) graph.poses[p] = make_pose((*positions)[p].col(0), (*rotations)[p]);
  return ChordalResult::kDone;
}

template ChordalResult initialise_chordal(PoseGraph<SE2>&);
template ChordalResult initialise_chordal(PoseGraph<SE3>&);

}  // namespace radioslam
