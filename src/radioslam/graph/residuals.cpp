#include "radioslam/graph/residuals.hpp"

#include "radioslam/graph/pose_chart.hpp"

namespace radioslam {

template <class Pose>
typename Pose::Tangent residual(const PoseGraph<Pose>& graph, const RelativePoseFactor<Pose>& factor) {
  const Pose T_i_j = graph.poses[factor.i.index()].inverse() * graph.poses[factor.j.index()];
  typename Pose::Tangent r = chart_error(graph.chart, factor.T_i_j.inverse() * T_i_j);
  if (factor.drift.valid()) r -= factor.drift_jacobian * graph.drifts[factor.drift.index()];
  return r;
}

template <class Pose>
Eigen::Matrix<double, 1, 1> residual(const PoseGraph<Pose>& graph, const RangeFactor<Pose>& factor) {
  const typename Pose::Point difference = position(graph, factor.j) - position(graph, factor.i);
  const double bias_m = factor.bias.valid() ? graph.range_biases[factor.bias.index()] : 0;
  return Eigen::Matrix<double, 1, 1>(length_unit(graph, factor) * difference.norm() + bias_m -
                                     factor.range_m);
}

template <class Pose>
typename Pose::Point residual(const PoseGraph<Pose>& graph, const BearingFactor<Pose>& factor) {
  return direction_or_zero(seen_by_receiver(graph, factor)) - factor.direction;
}

template <class Pose>
typename Pose::Point residual(const PoseGraph<Pose>& graph, const RelativePointFactor<Pose>& factor) {
  return graph.poses[factor.i.index()].inverse() * position(graph, factor.j) - factor.position;
}

template <class Pose>
typename Pose::Point residual(const PoseGraph<Pose>& graph, const PositionFactor<Pose>& factor) {
  return position(graph, factor.i) - factor.position;
}

template <class Pose>
typename Pose::Tangent residual(const PoseGraph<Pose>& graph, const PosePriorFactor<Pose>& factor) {
  const Pose& pose = graph.poses[factor.i.index()];
  if constexpr (Pose::kDim == 3)
    if (factor.gravity_only) {
      typename Pose::Tangent r = Pose::Tangent::Zero();
      r.template tail<3>() = vertical_in_body(pose).cross(vertical_in_body(factor.prior));
      return r;
    }
  return chart_error(graph.chart, factor.prior.inverse() * pose);
}

template <class Pose>
Drift residual(const PoseGraph<Pose>& graph, const DriftPriorFactor& factor) {
  return graph.drifts[factor.i.index()] - factor.mean;
}

template <class Pose>
Eigen::Matrix<double, 1, 1> residual(const PoseGraph<Pose>& graph, const RangeBiasPriorFactor& factor) {
  const double mean_m = factor.mean_m + (factor.of.valid() ? graph.range_biases[factor.of.index()] : 0);
  return Eigen::Matrix<double, 1, 1>(graph.range_biases[factor.i.index()] - mean_m);
}

#define RADIOSLAM_RESIDUALS(Pose)                                                                  \
  template Pose::Tangent residual(const PoseGraph<Pose>&, const RelativePoseFactor<Pose>&);        \
  template Eigen::Matrix<double, 1, 1> residual(const PoseGraph<Pose>&, const RangeFactor<Pose>&); \
  template Pose::Point residual(const PoseGraph<Pose>&, const BearingFactor<Pose>&);               \
  template Pose::Point residual(const PoseGraph<Pose>&, const RelativePointFactor<Pose>&);         \
  template Pose::Point residual(const PoseGraph<Pose>&, const PositionFactor<Pose>&);              \
  template Pose::Tangent residual(const PoseGraph<Pose>&, const PosePriorFactor<Pose>&);           \
  template Drift residual(const PoseGraph<Pose>&, const DriftPriorFactor&);                        \
  template Eigen::Matrix<double, 1, 1> residual(const PoseGraph<Pose>&, const RangeBiasPriorFactor&);
RADIOSLAM_RESIDUALS(SE2)
RADIOSLAM_RESIDUALS(SE3)
#undef RADIOSLAM_RESIDUALS

}  // namespace radioslam
