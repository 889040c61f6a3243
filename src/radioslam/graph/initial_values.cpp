#include "radioslam/graph/initial_values.hpp"

#include <cmath>

#include "radioslam/graph/chordal.hpp"
#include "radioslam/graph/optimizer.hpp"

namespace radioslam {
namespace {

/// Keeps the cheapest of the starts offered to it; a cost that is not a number loses.
template <class Pose>
class Choice {
 public:
  std::optional<double> offer(const PoseGraph<Pose>& graph, InitialValues kind) {
    const double cost = total_cost(graph);
    if (poses_.empty() || cost < cost_ || !std::isfinite(cost_)) {
      poses_ = graph.poses;
      cost_ = cost;
      kind_ = kind;
    }
    return cost;
  }
  InitialValues kind() const { return kind_; }
  const std::vector<Pose>& poses() const { return poses_; }

 private:
  std::vector<Pose> poses_;
  double cost_ = 0;
  InitialValues kind_ = InitialValues::kGiven;
};

}  // namespace

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

template <class Pose>
InitialCosts initialise(PoseGraph<Pose>& graph, GivenValues given) {
  const std::vector<Pose> original = graph.poses;
  Choice<Pose> choice;
  InitialCosts costs;
  if (given == GivenValues::kComplete) costs.given = choice.offer(graph, InitialValues::kGiven);
  if (initialise_chordal(graph) == ChordalResult::kDone)
    costs.chordal = choice.offer(graph, InitialValues::kChordal);
  graph.poses = original;
  initialise_from_spanning_tree(graph);
  costs.spanning_tree = choice.offer(graph, InitialValues::kSpanningTree);
  graph.poses = choice.poses();
  costs.chosen = choice.kind();
  return costs;
}

template InitialCosts initialise(PoseGraph<SE2>&, GivenValues);
template InitialCosts initialise(PoseGraph<SE3>&, GivenValues);

}  // namespace radioslam
