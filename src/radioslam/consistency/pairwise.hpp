// Which relative poses measured between two trajectories can be true together (pairwise consistency
// maximisation, Mangelson et al. 2018; Wi-Closure eq. 8-9 with the Jacobians corrected).
// Measurement i is Z_i = T_ai_bi between pose a_i of one trajectory and b_i of the other. With the odometry
// E = T_ai_aj and F = T_bi_bj in between,
//   xi = Log(Z_i F Z_j^-1 E^-1)
// is zero without noise. To first order, for right perturbations of Z_i, F, Z_j and E, its Jacobians are
//   Ad((F Z_j^-1 E^-1)^-1),  Ad((Z_j^-1 E^-1)^-1),  -Ad(E Z_j),  -Ad(E),
// which gives its covariance Sigma. i and j are consistent when xi^T Sigma^-1 xi is at most the chi-squared
// quantile of 3 (plane) or 6 degrees of freedom. For (j, i) and from robot b's side the
// statistic is the same to first order; each pair is tested once, as (later, earlier) in the list.
// For comparison with systems that do so, the test can be xi^T xi instead, which adds metres to radians.
// Metres and radians. The two trajectories are assumed independent, as it is for different
// robots. Cost: O(1) per pair of measurements, about two microseconds in space.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/consistency/pose_chain.hpp"
#include "radioslam/consistency/undirected_graph.hpp"
#include "radioslam/geometry/uncertain_pose.hpp"

namespace radioslam {

/// Measured relative pose T_a_b of pose `pose_b` of trajectory b from pose `pose_a` of trajectory a.
template <class Pose>
struct RelativePoseMatch {
  std::size_t pose_a = 0, pose_b = 0;
  Pose T_a_b;
  typename Pose::Jacobian covariance = Pose::Jacobian::Identity();  ///< right perturbation; positive definite
};

/// Derivatives of Log(Z_i F Z_j^-1 E^-1) under right perturbations, where it is near zero.
template <class Pose>
struct LoopJacobians {
  typename Pose::Jacobian z_i, f, z_j, e;
};

template <class Pose>
LoopJacobians<Pose> loop_jacobians(const Pose& f, const Pose& z_j, const Pose& e);

/// xi^T Sigma^-1 xi; infinite where Sigma is not positive definite.
template <class Pose>
double loop_statistic(const UncertainPose<Pose>& z_i, const UncertainPose<Pose>& f,
                      const UncertainPose<Pose>& z_j, const UncertainPose<Pose>& e);

/// The statistic of two matches between chains a and b.
template <class Pose>
double pair_statistic(const PoseChain<Pose>& chain_a, const PoseChain<Pose>& chain_b,
                      const RelativePoseMatch<Pose>& i, const RelativePoseMatch<Pose>& j);

struct PairwiseParams {
  double confidence = 0.99;
  /// If set, a pair passes up to this sqrt(xi^T xi), whatever the covariances; its statistic is xi^T xi.
  std::optional<double> max_norm;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(
        confidence, "", 0.5, 0.999999,
        "probability that a true pair of matches passes the consistency test; higher values reject fewer");
  }
};

/// Test results of all pairs of n matches.
struct PairwiseConsistency {
  UndirectedGraph graph;          ///< a vertex per match, an edge per consistent pair
  double gate = 0;                ///< the largest statistic that passes
  std::vector<float> statistics;  ///< of pairs i > j at i (i - 1) / 2 + j

  double statistic(std::size_t i, std::size_t j) const {
    const std::size_t high = std::max(i, j), low = std::min(i, j);
    return static_cast<double>(statistics[high * (high - 1) / 2 + low]);
  }
};

/// Tests every pair, on several threads. Pose numbers must be within the chains.
template <class Pose>
PairwiseConsistency pairwise_consistency(const PoseChain<Pose>& chain_a, const PoseChain<Pose>& chain_b,
                                         const std::vector<RelativePoseMatch<Pose>>& matches,
                                         const PairwiseParams& params = {});

}  // namespace radioslam
