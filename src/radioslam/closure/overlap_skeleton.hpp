// A pose graph cut down to the poses that hold the team together. Most poses touch nothing but the odometry
// to their neighbours; between two poses that touch more (the skeleton) they form a stretch, which can be
// summed into one factor without changing the estimate of the rest: with zeta = Ad(T_c1^-1 T_k) xi_k,
// perturbations in the body frame of the stretch's first pose c1,
//   zeta_k = zeta_c1 + G_k drift + w_k,   Cov(w_k) = S_k = sum Ad(U_j) Q_j Ad(U_j)^T,  G_k = sum Ad(U_j) g_j
// for U_j = T_c1^-1 T_j, and Q_j, g_j each step's covariance and drift at the current values (loss weights
// included). This is the normal equations' own model, so covariances of the reduced graph are those of the
// whole. A step whose information is singular, a second factor between the same poses, and a change of drift
// end a stretch; so do poses that hold or fix the gauge.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/closure/overlap_relative.hpp"
#include "radioslam/graph/pose_graph.hpp"

namespace radioslam {

/// One robot's poses in a graph.
struct ChainOfPoses {
  std::vector<PoseId> poses;          ///< in the order of time; a RelativePoseFactor from each to the next
  std::vector<std::size_t> searched;  ///< places in `poses` of those to compare, increasing; empty: all
};

/// Odometry from one pose of a chain to the next: xi_j = Ad(T_j^-1 T_i) xi_i + drift_effect * drift + noise.
template <class Pose>
struct ChainStep {
  typename Pose::Jacobian covariance;
  Eigen::Matrix<double, Pose::kDof, 2> drift_effect;
  DriftId drift{};
};

/// Poses [first, last] of a chain, of which only the ends are in the skeleton.
struct Stretch {
  std::size_t first = 0, last = 0;
  DriftId drift{};
};

template <class Pose>
struct SkeletonChain {
  std::vector<std::optional<ChainStep<Pose>>> steps;  ///< from pose k to k + 1, where odometry says enough
  std::vector<Stretch> stretches;                     ///< in order; every pose is in one
};

template <class Pose>
struct Skeleton {
  PoseGraph<Pose> graph;                ///< reduced
  std::vector<PoseId> of_pose;          ///< per pose of the whole graph; invalid: inside a stretch
  std::vector<std::int32_t> component;  ///< per pose of the whole graph
  std::vector<SkeletonChain<Pose>> chains;
};

/// Every chain names poses of the graph, each at most once.
template <class Pose>
Skeleton<Pose> reduce_to_skeleton(const PoseGraph<Pose>& graph, const std::vector<ChainOfPoses>& chains);

/// w_k and G_k of the poses after a stretch's first, one step after the other.
template <class Pose>
class StretchSums {
 public:
  using Jacobian = typename Pose::Jacobian;
  using DriftEffect = Eigen::Matrix<double, Pose::kDof, 2>;

  void add(const ChainStep<Pose>& step, const Pose& U_j) {
    const Jacobian ad = U_j.adjoint();
    covariance_ += ad * step.covariance * ad.transpose();
    drift_effect_ += ad * step.drift_effect;
  }
  const Jacobian& covariance() const { return covariance_; }
  const DriftEffect& drift_effect() const { return drift_effect_; }

 private:
  Jacobian covariance_ = Jacobian::Zero();
  DriftEffect drift_effect_ = DriftEffect::Zero();
};

}  // namespace radioslam
