#include "radioslam/graph/linearisation.hpp"

#include "radioslam/geometry/so3.hpp"
#include "radioslam/graph/pose_chart.hpp"
#include "radioslam/graph/residuals.hpp"

namespace radioslam {
namespace {

template <class Pose>
using PointJacobian = Eigen::Matrix<double, Pose::kDim, Pose::kDof>;

/// d(Exp(phi) v) / d phi at 0: the quarter turn of v in the plane, -[v]x in space.
Eigen::Vector2d rotation_derivative(const Eigen::Vector2d& v) { return {-v.y(), v.x()}; }
Eigen::Matrix3d rotation_derivative(const Eigen::Vector3d& v) { return skew(-v); }

/// How an end moves: R [I, d(Exp(phi) lever_arm)] for a pose.
template <class Pose>
PointJacobian<Pose> position_jacobian(const PoseGraph<Pose>& graph, const RangeEnd<Pose>& end) {
  constexpr int kDim = Pose::kDim, kRotation = Pose::kDof - Pose::kDim;
  PointJacobian<Pose> j = PointJacobian<Pose>::Zero();
  if (!end.pose.valid()) {
    j.template leftCols<kDim>().setIdentity();
    return j;
  }
  const auto r = graph.poses[end.pose.index()].rotation_matrix();
  j.template leftCols<kDim>() = r;
  j.template rightCols<kRotation>() = r * rotation_derivative(end.lever_arm);
  return j;
}

/// How a point seen from a pose's body moves when the pose does: -[I, d(Exp(phi) seen)].
template <class Pose>
PointJacobian<Pose> seen_by_jacobian(const typename Pose::Point& seen) {
  PointJacobian<Pose> j;
  j.template leftCols<Pose::kDim>() = -Eigen::Matrix<double, Pose::kDim, Pose::kDim>::Identity();
  j.template rightCols<Pose::kDof - Pose::kDim>() = -rotation_derivative(seen);
  return j;
}

}  // namespace

template <class Pose>
Linearisation<Pose::kDof, Pose::kDof, Pose::kDof, 2> linearise(const PoseGraph<Pose>& graph,
                                                               const RelativePoseFactor<Pose>& factor) {
  const Pose T_i_j = graph.poses[factor.i.index()].inverse() * graph.poses[factor.j.index()];
  const Pose error = factor.T_i_j.inverse() * T_i_j;
  Linearisation<Pose::kDof, Pose::kDof, Pose::kDof, 2> l;
  auto& [by_i, by_j, by_drift] = l.jacobians;
  l.residual = chart_error(graph.chart, error);
  by_j = chart_derivative(graph.chart, error);
  by_i.noalias() = -by_j * T_i_j.inverse().adjoint();
  by_drift = -factor.drift_jacobian;
  if (factor.drift.valid()) l.residual += by_drift * graph.drifts[factor.drift.index()];
  return l;
}

template <class Pose>
Linearisation<1, Pose::kDof, Pose::kDof, 2> linearise(const PoseGraph<Pose>& graph,
                                                      const RangeFactor<Pose>& factor) {
  const typename Pose::Point difference = position(graph, factor.j) - position(graph, factor.i);
  const typename Pose::Point along = direction_or_zero(difference);
  const double unit = length_unit(graph, factor);
  Linearisation<1, Pose::kDof, Pose::kDof, 2> l;
  l.residual = residual(graph, factor);
  std::get<0>(l.jacobians) = -unit * along.transpose() * position_jacobian(graph, factor.i);
  std::get<1>(l.jacobians) = unit * along.transpose() * position_jacobian(graph, factor.j);
  if (factor.drift.valid())
    std::get<2>(l.jacobians) << 0, difference.norm() * unit * unit;
  else
    std::get<2>(l.jacobians) << 1, 0;
  return l;
}

template <class Pose>
Linearisation<Pose::kDim, Pose::kDof, Pose::kDof> linearise(const PoseGraph<Pose>& graph,
                                                            const BearingFactor<Pose>& factor) {
  using Square = Eigen::Matrix<double, Pose::kDim, Pose::kDim>;
  const Pose& T_w_i = graph.poses[factor.i.index()];
  const typename Pose::Point seen = T_w_i.inverse() * position(graph, factor.j);  // by i's body
  const Square turn = factor.T_i_receiver.rotation_matrix().transpose();
  const typename Pose::Point compared = compared_part<Pose>(factor, factor.T_i_receiver.inverse() * seen);
  const typename Pose::Point u = direction_or_zero(compared);
  Square across = Square::Zero();  // d(v / |v|) / dv
  if (!u.isZero(0)) across = (Square::Identity() - u * u.transpose()) / compared.norm();
  if constexpr (Pose::kDim == 3)
    if (factor.azimuth_only) across.col(2).setZero();
  across = (across * turn).eval();
  Linearisation<Pose::kDim, Pose::kDof, Pose::kDof> l;
  l.residual = u - factor.direction;
  std::get<0>(l.jacobians) = across * seen_by_jacobian<Pose>(seen);
  std::get<1>(l.jacobians) =
      across * T_w_i.rotation_matrix().transpose() * position_jacobian(graph, factor.j);
  return l;
}

template <class Pose>
Linearisation<Pose::kDim, Pose::kDof, Pose::kDof> linearise(const PoseGraph<Pose>& graph,
                                                            const RelativePointFactor<Pose>& factor) {
  const Pose& T_w_i = graph.poses[factor.i.index()];
  const typename Pose::Point seen = T_w_i.inverse() * position(graph, factor.j);
  return {seen - factor.position,
          {seen_by_jacobian<Pose>(seen),
           T_w_i.rotation_matrix().transpose() * position_jacobian(graph, factor.j)}};
}

template <class Pose>
Linearisation<Pose::kDim, Pose::kDof> linearise(const PoseGraph<Pose>& graph,
                                                const PositionFactor<Pose>& factor) {
  return {residual(graph, factor), {position_jacobian(graph, factor.i)}};
}

template <class Pose>
Linearisation<Pose::kDof, Pose::kDof> linearise(const PoseGraph<Pose>& graph,
                                                const PosePriorFactor<Pose>& factor) {
  if constexpr (Pose::kDim == 3)
    if (factor.gravity_only) {
      Linearisation<Pose::kDof, Pose::kDof> l;
      l.residual = residual(graph, factor);
      std::get<0>(l.jacobians).setZero();
      std::get<0>(l.jacobians).template bottomRightCorner<3, 3>() =
          -skew(vertical_in_body(factor.prior)) * skew(vertical_in_body(graph.poses[factor.i.index()]));
      return l;
    }
  const Pose error = factor.prior.inverse() * graph.poses[factor.i.index()];
  return {chart_error(graph.chart, error), {chart_derivative(graph.chart, error)}};
}

template <class Pose>
Linearisation<2, 2> linearise(const PoseGraph<Pose>& graph, const DriftPriorFactor& factor) {
  return {residual(graph, factor), {Eigen::Matrix2d::Identity()}};
}

template <class Pose>
Linearisation<1, 1, 1> linearise(const PoseGraph<Pose>& graph, const RangeBiasPriorFactor& factor) {
  using One = Eigen::Matrix<double, 1, 1>;
  return {residual(graph, factor), {One::Identity(), -One::Identity()}};
}

#define RADIOSLAM_LINEARISE(Pose)                                                                           \
  template Linearisation<Pose::kDof, Pose::kDof, Pose::kDof, 2> linearise(const PoseGraph<Pose>&,           \
                                                                          const RelativePoseFactor<Pose>&); \
  template Linearisation<1, Pose::kDof, Pose::kDof, 2> linearise(const PoseGraph<Pose>&,                    \
                                                                 const RangeFactor<Pose>&);                 \
  template Linearisation<Pose::kDim, Pose::kDof, Pose::kDof> linearise(const PoseGraph<Pose>&,              \
                                                                       const BearingFactor<Pose>&);         \
  template Linearisation<Pose::kDim, Pose::kDof, Pose::kDof> linearise(const PoseGraph<Pose>&,              \
                                                                       const RelativePointFactor<Pose>&);   \
  template Linearisation<Pose::kDim, Pose::kDof> linearise(const PoseGraph<Pose>&,                          \
                                                           const PositionFactor<Pose>&);                    \
  template Linearisation<Pose::kDof, Pose::kDof> linearise(const PoseGraph<Pose>&,                          \
                                                           const PosePriorFactor<Pose>&);                   \
  template Linearisation<2, 2> linearise(const PoseGraph<Pose>&, const DriftPriorFactor&);                  \
  template Linearisation<1, 1, 1> linearise(const PoseGraph<Pose>&, const RangeBiasPriorFactor&);
RADIOSLAM_LINEARISE(SE2)
RADIOSLAM_LINEARISE(SE3)
#undef RADIOSLAM_LINEARISE

}  // namespace radioslam
