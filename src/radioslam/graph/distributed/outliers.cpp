#include "radioslam/graph/distributed/outliers.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "radioslam/graph/graduated.hpp"

namespace radioslam {

TruncatedWeight truncated_weight(double squared_norm, double gate, double mu) {
  const double weight = surrogate_weight(GraduatedLoss::kTruncatedLeastSquares, mu, squared_norm, gate);
  return {weight, mu * (1 - weight) / (mu + weight) * gate};
}

template <class Pose>
void discount_repeated(PoseGraph<Pose>& graph) {
  using Ends = std::pair<std::int32_t, std::int32_t>;
  const auto ends = [](const RelativePoseFactor<Pose>& f) -> Ends {
    return std::minmax(f.i.value, f.j.value);
  };
  std::map<Ends, int> count;
  for (const auto& f : graph.relative_poses) ++count[ends(f)];
  for (auto& f : graph.relative_poses)
    if (const auto [first, last] = ends(f); last != first + 1) f.weight /= count.at({first, last});
}

template <class Pose>
std::vector<bool> outlier_candidates(const RobotGraph<Pose>& robot) {
  std::vector<bool> candidates(robot.graph.relative_poses.size(), true);
  std::vector<bool> stepped(robot.own_poses, false);
  for (std::size_t k = 0; k < robot.own_relative_poses; ++k) {
    const auto& factor = robot.graph.relative_poses[k];
    const std::size_t first = std::min(factor.i.index(), factor.j.index());
    const bool step = std::max(factor.i.index(), factor.j.index()) == first + 1;
    if (!step || stepped[first]) continue;
    stepped[first] = true;
    candidates[k] = false;
  }
  return candidates;
}

template void discount_repeated(PoseGraph<SE2>&);
template void discount_repeated(PoseGraph<SE3>&);
template std::vector<bool> outlier_candidates(const RobotGraph<SE2>&);
template std::vector<bool> outlier_candidates(const RobotGraph<SE3>&);

}  // namespace radioslam
