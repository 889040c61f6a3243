// The residual of every factor at the graph's current values, and what it weighs.
// Formulas: with the factors in pose_graph.hpp. Ends closer than kMinimumDistance_m have no direction: the
// unit vector between them is taken as zero.
#pragma once

#include <algorithm>

#include "radioslam/graph/pose_graph.hpp"

namespace radioslam {

inline constexpr double kMinimumDistance_m = 1e-9;

/// Residuals; a range's and a bearing's are divided by sigma in squared_norm, not here.
template <class Pose>
typename Pose::Tangent residual(const PoseGraph<Pose>& graph, const RelativePoseFactor<Pose>& factor);
template <class Pose>
Eigen::Matrix<double, 1, 1> residual(const PoseGraph<Pose>& graph, const RangeFactor<Pose>& factor);
template <class Pose>
typename Pose::Point residual(const PoseGraph<Pose>& graph, const BearingFactor<Pose>& factor);
template <class Pose>
typename Pose::Point residual(const PoseGraph<Pose>& graph, const RelativePointFactor<Pose>& factor);
template <class Pose>
typename Pose::Point residual(const PoseGraph<Pose>& graph, const PositionFactor<Pose>& factor);
template <class Pose>
typename Pose::Tangent residual(const PoseGraph<Pose>& graph, const PosePriorFactor<Pose>& factor);
template <class Pose>
Drift residual(const PoseGraph<Pose>& graph, const DriftPriorFactor& factor);
template <class Pose>
Eigen::Matrix<double, 1, 1> residual(const PoseGraph<Pose>& graph, const RangeBiasPriorFactor& factor);

/// Where an end is, in the graph's frame.
template <class Pose>
typename Pose::Point position(const PoseGraph<Pose>& graph, const RangeEnd<Pose>& end) {
  if (!end.pose.valid()) return graph.points[end.point.index()];
  return graph.poses[end.pose.index()] * end.lever_arm;
}

/// Upper limit of the scale error in a range's unit, a step stretched twentyfold.
inline constexpr double kMaxScaleError = 0.95;

/// A true metre in the odometry units that a range was learnt in, 1 / (1 - scale error); the scale error is
/// relative to the odometry's own length.
template <class Pose>
double length_unit(const PoseGraph<Pose>& graph, const RangeFactor<Pose>& factor) {
  if (!factor.drift.valid()) return 1;
  return 1 / (1 - std::min(graph.drifts[factor.drift.index()][1], kMaxScaleError));
}

/// v / |v|, or zero where v is too short to have a direction.
template <class Vector>
Vector direction_or_zero(const Vector& v) {
  const double norm = v.norm();
  return norm < kMinimumDistance_m ? Vector(Vector::Zero()) : Vector(v / norm);
}

/// The vertical of the graph's frame, in a body's frame.
inline Eigen::Vector3d vertical_in_body(const SE3& T_frame_body) {
  return T_frame_body.rotation().conjugate() * Eigen::Vector3d::UnitZ();
}

/// What a bearing compares of where its end j is in the receiver's frame: for an azimuth alone, the
/// projection to the xy-plane.
template <class Pose>
typename Pose::Point compared_part(const BearingFactor<Pose>& factor, typename Pose::Point seen) {
  if constexpr (Pose::kDim == 3)
    if (factor.azimuth_only) seen.z() = 0;
  return seen;
}
template <class Pose>
typename Pose::Point seen_by_receiver(const PoseGraph<Pose>& graph, const BearingFactor<Pose>& factor) {
  const Pose T_graph_receiver = graph.poses[factor.i.index()] * factor.T_i_receiver;
  return compared_part<Pose>(factor, T_graph_receiver.inverse() * position(graph, factor.j));
}

/// Distance from a bearing's receiver to its other end.
template <class Pose>
double distance_m(const PoseGraph<Pose>& graph, const auto& bearing) {
  const Pose& T_graph_i = graph.poses[bearing.i.index()];
  return (position(graph, bearing.j) - T_graph_i * bearing.T_i_receiver.translation()).norm();
}

/// The information of a factor, without weight and loss.
template <class Pose>
const typename Pose::Jacobian& information(const RelativePoseFactor<Pose>& factor) {
  return factor.information;
}
template <class Pose>
Eigen::Matrix<double, 1, 1> information(const RangeFactor<Pose>& factor) {
  return Eigen::Matrix<double, 1, 1>(1 / (factor.sigma_m * factor.sigma_m));
}
template <class Pose>
Eigen::Matrix<double, Pose::kDim, Pose::kDim> information(const BearingFactor<Pose>& factor) {
  return Eigen::Matrix<double, Pose::kDim, Pose::kDim>::Identity() / (factor.sigma_rad * factor.sigma_rad);
}
template <class Pose>
const Eigen::Matrix<double, Pose::kDim, Pose::kDim>& information(const RelativePointFactor<Pose>& factor) {
  return factor.information;
}
template <class Pose>
const Eigen::Matrix<double, Pose::kDim, Pose::kDim>& information(const PositionFactor<Pose>& factor) {
  return factor.information;
}
template <class Pose>
const typename Pose::Jacobian& information(const PosePriorFactor<Pose>& factor) {
  return factor.information;
}
inline const Eigen::Matrix2d& information(const DriftPriorFactor& factor) { return factor.information; }
inline Eigen::Matrix<double, 1, 1> information(const RangeBiasPriorFactor& factor) {
  return Eigen::Matrix<double, 1, 1>(1 / (factor.sigma_m * factor.sigma_m));
}

/// Weight and loss; the priors of drifts and biases have neither.
inline double weight(const DriftPriorFactor&) { return 1; }
inline double weight(const RangeBiasPriorFactor&) { return 1; }
inline double weight(const auto& factor) { return factor.weight; }
inline Loss loss(const DriftPriorFactor&) { return {}; }
inline Loss loss(const RangeBiasPriorFactor&) { return {}; }
inline Loss loss(const auto& factor) { return factor.loss; }

/// The squared Mahalanobis norm of a factor's residual, before its weight and its loss: the statistic to
/// hold against a chi-squared quantile.
template <class Pose, class Factor>
double squared_norm(const PoseGraph<Pose>& graph, const Factor& factor) {
  const auto r = residual(graph, factor);
  return r.dot(information(factor) * r);
}

}  // namespace radioslam
