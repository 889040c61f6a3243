#include "radioslam/joint/graduated_optimization.hpp"

#include <algorithm>

namespace radioslam {
namespace {

constexpr double kCoarseTolerance = 1e-3;  // relative cost tolerance of all stages but the last

template <class Pose>
void set_loss_scale(JointGraph<Pose>& joint, double scale) {
  auto& ranges = joint.team.graph.ranges;
  for (std::size_t k = 0; k < ranges.size(); ++k)
    if (joint.origins.ranges[k].source == FactorSource::kFingerprint)
      ranges[k].loss = {LossKind::kCauchy, scale};
}

}  // namespace

template <class Pose>
OptimizerSummary optimize_robustly(JointGraph<Pose>& joint, const RobustParams& robust,
                                   const OptimizerParams& optimizer, const Progress& progress) {
  OptimizerParams coarse = optimizer;
  coarse.relative_cost_tolerance = std::max(kCoarseTolerance, optimizer.relative_cost_tolerance);
  int iterations = 0;
  double scale = robust.first_scale;
  while (scale > robust.final_scale) {
    set_loss_scale(joint, scale);
    scale *= robust.step;
    iterations += optimize(joint.team.graph, coarse, progress).iterations;
  }
  set_loss_scale(joint, robust.final_scale);
  OptimizerSummary summary = optimize(joint.team.graph, optimizer, progress);
  summary.iterations += iterations;
  return summary;
}

template OptimizerSummary optimize_robustly<SE2>(JointGraph<SE2>&, const RobustParams&,
                                                 const OptimizerParams&, const Progress&);
template OptimizerSummary optimize_robustly<SE3>(JointGraph<SE3>&, const RobustParams&,
                                                 const OptimizerParams&, const Progress&);

}  // namespace radioslam
