// First-order models of the factors: residual(x + d) = residual + sum_k jacobians_k d_k, with poses
// perturbed on the right. Derivations: for E = Z^-1 T_i^-1 T_j, perturbing T_j multiplies E by Exp(xi) and
// perturbing T_i by Exp(-Ad(T_j^-1 T_i) xi).
#pragma once

#include <tuple>

#include "radioslam/graph/pose_graph.hpp"

namespace radioslam {

/// `Columns` are those of the factor's variables, in the order of variables(factor). An end that may be a
/// pose or a point has a pose's columns; for a point those after the first kDim are zero. A range's drift or
/// bias has a drift's columns; for a bias the second is zero.
template <int Rows, int... Columns>
struct Linearisation {
  Eigen::Matrix<double, Rows, 1> residual;
  std::tuple<Eigen::Matrix<double, Rows, Columns>...> jacobians;
};

template <class Pose>
Linearisation<Pose::kDof, Pose::kDof, Pose::kDof, 2> linearise(const PoseGraph<Pose>& graph,
                                                               const RelativePoseFactor<Pose>& factor);
template <class Pose>
Linearisation<1, Pose::kDof, Pose::kDof, 2> linearise(const PoseGraph<Pose>& graph,
                                                      const RangeFactor<Pose>& factor);
template <class Pose>
Linearisation<Pose::kDim, Pose::kDof, Pose::kDof> linearise(const PoseGraph<Pose>& graph,
                                                            const BearingFactor<Pose>& factor);
template <class Pose>
Linearisation<Pose::kDim, Pose::kDof, Pose::kDof> linearise(const PoseGraph<Pose>& graph,
                                                            const RelativePointFactor<Pose>& factor);
template <class Pose>
Linearisation<Pose::kDim, Pose::kDof> linearise(const PoseGraph<Pose>& graph,
                                                const PositionFactor<Pose>& factor);
template <class Pose>
Linearisation<Pose::kDof, Pose::kDof> linearise(const PoseGraph<Pose>& graph,
                                                const PosePriorFactor<Pose>& factor);
template <class Pose>
Linearisation<2, 2> linearise(const PoseGraph<Pose>& graph, const DriftPriorFactor& factor);
template <class Pose>
Linearisation<1, 1, 1> linearise(const PoseGraph<Pose>& graph, const RangeBiasPriorFactor& factor);

}  // namespace radioslam
