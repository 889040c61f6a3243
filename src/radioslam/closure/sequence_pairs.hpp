// Likelihood of the relative pose of two path segments from fingerprint pairs, and its maximum.
// Every pair of fingerprints p (of window i) and q (of window j) whose similarity s predicts a distance adds
//   rho((|T p - q| - peak(s)) / spread(s)),   rho(r) = c^2 log(1 + r^2 / c^2)   (Cauchy)
// with T = T_j_i and the Gaussian over distance that the team's model predicts for s (PredictedDistance).
// Metres and radians; T is perturbed as T Exp(xi), xi = [translation, yaw].
#pragma once

#include <Eigen/Core>
#include <vector>

#include "radioslam/closure/sequence_window.hpp"
#include "radioslam/geometry/se2.hpp"

namespace radioslam {

/// Positions of two fingerprints, each in its window, and the distance predicted from their similarity.
struct PredictedPair {
  Eigen::Vector2d p, q;
  double peak_m = 0;
  double spread_m = 1;
};

/// Pairs of two windows whose similarity predicts a distance; `similarity` has a row per node of i and a
/// column per node of j.
std::vector<PredictedPair> predicted_pairs(const DistanceModel& model, const Eigen::MatrixXd& similarity,
                                           const SequenceWindow& i, const SequenceWindow& j);

struct PairCost {
  double cost = 0;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< as if all pairs were independent
};

/// Cost O(pairs).
PairCost evaluate_pairs(const SE2& T_j_i, const std::vector<PredictedPair>& pairs, double loss_sigmas);

struct PairFit {
  SE2 T_j_i;
  PairCost at;
};

/// Local minimum from `start`, by Levenberg-Marquardt.
PairFit fit_pairs(const SE2& start, const std::vector<PredictedPair>& pairs, double loss_sigmas);

}  // namespace radioslam
