#include "radioslam/graph/distributed/step_system.hpp"

namespace radioslam {

template <class Pose>
StepSystem<Pose>::StepSystem(const PoseGraph<Pose>& graph) : equations_(graph) {}

template <class Pose>
bool StepSystem<Pose>::linearise(const PoseGraph<Pose>& graph) {
  cost_ = equations_.linearise(graph);
  couplings_.clear();
  for (const auto& f : graph.relative_poses) couple(graph, f);
  reached_ = Eigen::VectorXd::Zero(equations_.gradient().size());
  return equations_.empty() || equations_.factorize(0) == Factorization::kDone;
}

template <class Pose>
void StepSystem<Pose>::couple(const PoseGraph<Pose>& graph, const RelativePoseFactor<Pose>& factor) {
  const auto& fixed = graph.pose_fixed;
  if (fixed[factor.i.index()] == fixed[factor.j.index()]) return;
  const bool first_free = fixed[factor.j.index()];
  const std::int32_t block = equations_.blocks().poses[(first_free ? factor.i : factor.j).index()];
  if (block < 0) return;
  const FactorSlots<3> both{{0, 1, -1}, {0, -1, -1}};
  SumsOf<Pose, RelativePoseFactor<Pose>> sums;
  compute_sums(graph, factor, both, sums);
  const typename Pose::Jacobian& h_j_i = std::get<0>(sums.lower);
  couplings_.push_back(
      {static_cast<Eigen::Index>(equations_.matrix().offset(static_cast<std::size_t>(block))),
       (first_free ? factor.j : factor.i).index(), h_j_i});
  if (first_free) couplings_.back().information.transposeInPlace();
}

template <class Pose>
double StepSystem<Pose>::move(Steps& steps, double relaxation) {
  if (equations_.empty()) return 0;
  Eigen::VectorXd missing = -equations_.gradient() - reached_;
  for (const Coupling& c : couplings_)
    missing.segment<Pose::kDof>(c.offset) -= c.information * steps[c.fixed];
  const Eigen::VectorXd change = equations_.cholesky().solve(missing);
  reached_ += relaxation * missing;
  const auto& blocks = equations_.blocks().poses;
  for (std::size_t p = 0; p < blocks.size(); ++p)
    if (blocks[p] >= 0)
      steps[p] += relaxation * change.segment<Pose::kDof>(static_cast<Eigen::Index>(
                                   equations_.matrix().offset(static_cast<std::size_t>(blocks[p]))));
  return missing.dot(change);
}

template class StepSystem<SE2>;
template class StepSystem<SE3>;

}  // namespace radioslam
