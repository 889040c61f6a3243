#include "radioslam/joint/closures/loop_choice.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/graph/residuals.hpp"

namespace radioslam {

template <class Pose>
void set_weights(LoopChoice<Pose>& choice) {
  for (std::size_t k = 0; k < choice.gates.size(); ++k) choice.loop(k).weight = choice.accepted[k] ? 1 : 0;
}

template <class Pose>
double truncated_cost(const LoopChoice<Pose>& choice) {
  double cost = total_cost(choice.graph);
  for (std::size_t k = 0; k < choice.gates.size(); ++k) {
    const double norm = squared_norm(choice.graph, choice.loop(k));
    cost += std::min(choice.gates[k], norm) - choice.loop(k).weight * norm;
  }
  return cost;
}

template <class Pose>
void choose_gradually(LoopChoice<Pose>& choice, std::span<const std::size_t> decided, Fate fate,
                      const GraduatedParams& params, const OptimizerParams& optimizer,
                      const Progress& progress) {
  FactorMask mask;
  mask.relative_poses.assign(choice.graph.relative_poses.size(), false);
  for (std::size_t k = 0; k < choice.gates.size(); ++k) {
    choice.loop(k).weight = 1;
    choice.loop(k).loss = {LossKind::kNone, std::sqrt(choice.gates[k])};
    mask.relative_poses[choice.first_loop() + k] = true;
  }
  for (const std::size_t k : decided) {
    choice.loop(k).weight = fate == Fate::kHolds ? 1 : 0;
    mask.relative_poses[choice.first_loop() + k] = false;
  }
  const auto weights = optimize_graduated(choice.graph, mask, GraduatedLoss::kTruncatedLeastSquares, params,
                                          optimizer, progress)
                           .weights.relative_poses;
  for (std::size_t k = 0; k < choice.gates.size(); ++k)
    choice.accepted[k] = weights[choice.first_loop() + k] > 0.5;
  for (const std::size_t k : decided) choice.accepted[k] = fate == Fate::kHolds;
  set_weights(choice);
}

#define RADIOSLAM_LOOP_CHOICE(Pose)                                                     \
  template void set_weights(LoopChoice<Pose>&);                                         \
  template double truncated_cost(const LoopChoice<Pose>&);                              \
  template void choose_gradually(LoopChoice<Pose>&, std::span<const std::size_t>, Fate, \
                                 const GraduatedParams&, const OptimizerParams&, const Progress&);
RADIOSLAM_LOOP_CHOICE(SE2)
RADIOSLAM_LOOP_CHOICE(SE3)
#undef RADIOSLAM_LOOP_CHOICE

}  // namespace radioslam
