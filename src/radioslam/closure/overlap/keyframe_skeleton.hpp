// Reduces a pose graph to its skeleton: the poses with factors other than the odometry to their neighbours.
//
// The poses between two skeleton poses form a segment, which is summed into one factor without changing the
// estimate of the rest. With zeta = Ad(T_c1^-1 T_k) xi_k, perturbations in the body frame of the segment's
// first pose c1,
//   zeta_k = zeta_c1 + G_k drift + w_k,   Cov(w_k) = S_k = sum Ad(U_j) Q_j Ad(U_j)^T,  G_k = sum Ad(U_j) g_j
// for U_j = T_c1^-1 T_j, and Q_j, g_j each step's covariance and drift at the current values (loss weights
// included). This is the model of the normal equations, so covariances of the reduced graph are those of the
// full one. A segment ends at a step with singular information, at a second factor between the same poses, at
// a change of drift, and at poses that fix the gauge.
#pragma once

#include <vector>

#include "radioslam/closure/overlap/chain_segments.hpp"
#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {

template <class Pose>
struct Skeleton {
  PoseGraph<Pose> graph;                ///< reduced
  std::vector<PoseId> of_pose;          ///< per pose of the full graph; invalid: inside a segment
  std::vector<std::int32_t> component;  ///< per pose of the full graph
  std::vector<SkeletonChain<Pose>> chains;
};

/// The chains must consist of poses of the graph, each at most once.
template <class Pose>
Skeleton<Pose> reduce_to_skeleton(const PoseGraph<Pose>& graph, const std::vector<ChainOfPoses>& chains);

/// Accumulates S_k and G_k along the poses of a segment, step by step.
template <class Pose>
class SegmentSums {
 public:
  using Jacobian = typename Pose::Jacobian;
  using DriftEffect = Eigen::Matrix<double, Pose::kDof, 2>;

  void add(const ChainStep<Pose>& step, const Pose& U_j) {
    const Jacobian ad = U_j.adjoint();
    covariance_ = congruence(ad, step.covariance, covariance_);
    drift_effect_ += ad * step.drift_effect;
  }
  const Jacobian& covariance() const { return covariance_; }
  const DriftEffect& drift_effect() const { return drift_effect_; }

 private:
  Jacobian covariance_ = Jacobian::Zero();
  DriftEffect drift_effect_ = DriftEffect::Zero();
};

}  // namespace radioslam
