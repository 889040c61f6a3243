#include "radioslam/graph/distributed/held_factors.hpp"

#include <algorithm>

namespace radioslam {
namespace {

/// How hard the first pose is held, relative to the strongest factor. Any number would do: nothing pulls.
constexpr double kAnchor = 100;

template <class Pose>
PoseGraph<Pose> graph_of(const RobotGraph<Pose>& robot, const std::vector<std::size_t>& factors) {
  PoseGraph<Pose> graph = robot.graph;
  graph.relative_poses.clear();
  for (const std::size_t k : factors) graph.relative_poses.push_back(robot.graph.relative_poses[k]);
  return graph;
}

template <class Pose>
typename Pose::Jacobian anchor_of(const PoseGraph<Pose>& graph) {
  typename Pose::Tangent strongest = Pose::Tangent::Ones();
  for (const auto& f : graph.relative_poses)
    strongest = strongest.cwiseMax(typename Pose::Tangent(f.information.diagonal()));
  return kAnchor * typename Pose::Jacobian(strongest.asDiagonal());
}

template <class Pose>
Gauge<Pose> gauge_of(const PoseGraph<Pose>& graph, bool anchored) {
  // Poses that no factor is about are no variables.
  Gauge<Pose> gauge{std::vector<bool>(graph.poses.size(), true), {}};
  for (const auto& f : graph.relative_poses) gauge.held[f.i.index()] = gauge.held[f.j.index()] = false;
  const auto first = std::find(gauge.held.begin(), gauge.held.end(), false);
  if (anchored && first != gauge.held.end())
    gauge.penalties.push_back(
        {PoseId(static_cast<std::size_t>(first - gauge.held.begin())), anchor_of(graph)});
  return gauge;
}

}  // namespace

template <class Pose>
HeldFactors<Pose>::HeldFactors(const RobotGraph<Pose>& robot, const std::vector<std::size_t>& factors,
                               std::vector<KeptPose> kept, bool anchored)
    : graph_(graph_of(robot, factors)),
      kept_(std::move(kept)),
      equations_(graph_, gauge_of(graph_, anchored)) {
  for (const auto& f : graph_.relative_poses) weights_.push_back(f.weight);
  std::vector<std::size_t> blocks;
  for (std::size_t k = 0; k < kept_.size(); ++k) {
    const std::int32_t block = equations_.blocks().poses[kept_[k].pose];
    if (block < 0) continue;
    blocks.push_back(static_cast<std::size_t>(block));
    for (Eigen::Index d = 0; d < Pose::kDof; ++d)
      kept_with_block_.push_back(static_cast<Eigen::Index>(k) * Pose::kDof + d);
  }
  if (!equations_.empty()) inner_.emplace(equations_.matrix().pattern(), blocks);
  if (anchored && factors.empty() && !kept_.empty()) kept_anchor_ = anchor_of(robot.graph);
}

template <class Pose>
std::vector<SharedPose> HeldFactors<Pose>::kept() const {
  std::vector<SharedPose> shared;
  for (const KeptPose& pose : kept_) shared.push_back(pose.shared);
  return shared;
}

template <class Pose>
double HeldFactors<Pose>::linearise(const std::vector<Pose>& poses, const std::vector<double>& weights) {
  graph_.poses = poses;
  for (std::size_t k = 0; k < weights_.size(); ++k)
    graph_.relative_poses[k].weight = weights.empty() ? weights_[k] : weights_[k] * weights[k];
  return equations_.linearise(graph_);
}

template <class Pose>
bool HeldFactors<Pose>::eliminate(double damping) {
  const auto size = static_cast<Eigen::Index>(kept_.size()) * Pose::kDof;
  information_ = Eigen::MatrixXd::Zero(size, size);
  if (kept_anchor_) information_.template topLeftCorner<Pose::kDof, Pose::kDof>() = *kept_anchor_;
  if (!inner_) return true;
  equations_.damp(damping);
  if (inner_->factorize(equations_.matrix()) != Factorization::kDone) return false;
  information_(kept_with_block_, kept_with_block_) = inner_->reduced();
  return true;
}

template <class Pose>
Eigen::VectorXd HeldFactors<Pose>::gradient() const {
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(kept_.size()) * Pose::kDof);
  if (inner_) gradient(kept_with_block_) = inner_->reduce(equations_.gradient());
  return gradient;
}

template <class Pose>
double HeldFactors<Pose>::predicted_decrease() const {
  return inner_ ? inner_->eliminated_norm(equations_.gradient()) : 0;
}

template <class Pose>
void HeldFactors<Pose>::apply(const Eigen::VectorXd& kept_steps, std::vector<Pose>& poses) const {
  for (std::size_t k = 0; k < kept_.size(); ++k)
    if (equations_.blocks().poses[kept_[k].pose] < 0)
      poses[kept_[k].pose] =
          poses[kept_[k].pose] *
          Pose::exp(kept_steps.template segment<Pose::kDof>(static_cast<Eigen::Index>(k) * Pose::kDof));
  if (!inner_) return;
  PoseGraph<Pose> moved;
  moved.poses = poses;
  const Eigen::VectorXd kept = kept_steps(kept_with_block_);
  equations_.apply(inner_->expand(-equations_.gradient(), kept), moved);
  poses = moved.poses;
}

template class HeldFactors<SE2>;
template class HeldFactors<SE3>;

}  // namespace radioslam
