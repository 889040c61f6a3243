// Which relative poses are worth measuring, where not all can be measured.
//
// A pair k of nodes (i, j) is worth the information that a closure between them is expected to add,
//   w p_k 1/2 log det(I + C_kk R^-1),
// w: weight of the hypothesis that predicts T_i_j; p_k: probability that the closure holds, given that; C_kk:
// covariance of T_i_j; R: that of a closure. Predictions of one hypothesis are correlated: with each choice
// those of the others become better known,
//   C <- C - C_.k (C_kk + R)^-1 C_k. ,
// so that a pair that repeats one that was chosen is worth less. Where all of one hypothesis hold,
// this is greedy maximisation of the information that all choices add together, which is submodular: the
// result has at least 1 - 1/e of the best one's (Nemhauser, Wolsey, Fisher 1978). Swarm-SLAM (Lajoie,
// Beltrame, RA-L 2024) chooses greedily as well, by the algebraic connectivity of the graph.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "radioslam/graph/marginals.hpp"

namespace radioslam {

/// A pair of nodes that a closure may connect.
struct WeighedPair {
  PoseId i, j;
  double probability = 1;      ///< that a closure holds, under the hypothesis
  std::size_t hypothesis = 0;  ///< that predicts the pair; hypotheses exclude one another
  double weight = 1;           ///< of the hypothesis
};

/// Poses of an estimate, and the marginals of its graph; covariances are `temperature` times what these say.
template <class Pose>
struct PredictedPoses {
  const std::vector<Pose>& poses;
  const Marginals<Pose>& marginals;
  double temperature = 1;
};

/// The `count` best of the pairs, as their indices, the best first; equal ones in their order. None that
/// would add less than `least_worth` (nats) to those chosen before. Cost for n pairs: a covariance each; for
/// every choice, a solution with the graph per degree of freedom, and O(n count); memory O(n count).
template <class Pose>
std::vector<std::size_t> choose_by_worth(const std::vector<WeighedPair>& pairs,
                                         const PredictedPoses<Pose>& predicted,
                                         const typename Pose::Jacobian& cov_closure, std::size_t count,
                                         double least_worth = 0);

/// Probability that a normal vector in the plane is shorter than this, by its principal axes; to 1e-3.
double probability_within(double radius_m, const Eigen::Vector2d& mean, const Eigen::Matrix2d& covariance);

}  // namespace radioslam
