// Relative pose of two path segments (windows) from the similarities of their fingerprints.
//
// 1. Matches. Every fingerprint of one window is matched to the similarity-weighted mean of the positions of
// its k
//    most similar ones in the other, x* = sum s x / sum s, in both directions; a rigid transform is fitted to
//    the matches (Umeyama, without scale). Source: Dammalapati and Hajdarpasic, WiFi Assisted Loop Closure
//    Detection, who stop here. A weighted mean lies inside the other window, so this estimate is biased
//    towards its centre.
// 2. Estimate. From there, the pose that maximises the likelihood of the distances predicted for all pairs of
//    fingerprints of the two windows (sequence_pairs.hpp), which is free of that bias.
// 3. Alternatives. Along a straight path, fingerprints measure the distance of a parallel path but not its
// side. The
//    estimate is repeated from the first one's reflections about either window's long axis and from three
//    other headings; the match is ambiguous if a different pose fits nearly as well.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/closure/sequence_window.hpp"
#include "radioslam/geometry/se2.hpp"

namespace radioslam {

// Likelihood of the relative pose of two path segments from fingerprint pairs, and its maximum.
// Every pair of fingerprints p (of window i) and q (of window j) whose similarity s predicts a distance adds
//   rho((|T p - q| - peak(s)) / spread(s)),   rho(r) = c^2 log(1 + r^2 / c^2)   (Cauchy)
// with T = T_j_i and the Gaussian over distance that the team's model predicts for s (PredictedDistance).
// Metres and radians; T is perturbed as T Exp(xi), xi = [translation, yaw].

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

struct SequenceMatchParams {
  int nearest = 3;  ///< k
  double loss_sigmas = 2;
  double max_residual_m = 3;
  double alternative_distance_m = 3;
  double alternative_angle_rad = 0.35;
  double min_alternative_margin = 10;
  double effective_sample_ratio = 0.2;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(nearest, "", 1, 100, "number of most similar fingerprints averaged for one match");
    RADIOSLAM_FIELD(loss_sigmas, "", 0.1, 1e6,
                    "scale of the Cauchy loss on predicted distances, in standard deviations");
    RADIOSLAM_FIELD(max_residual_m, "m", 0, 1000,
                    "largest mean distance of fingerprints from their matches; higher values keep more "
                    "closures but admit false ones");
    RADIOSLAM_FIELD(alternative_distance_m, "m", 0.01, 1000,
                    "distance from the best pose beyond which another solution counts as an alternative");
    RADIOSLAM_FIELD(alternative_angle_rad, "rad", 0.01, 7,
                    "rotation from the best pose beyond which another solution counts as an alternative");
    RADIOSLAM_FIELD(min_alternative_margin, "", 0, 1e6,
                    "smallest cost margin over alternative poses (chi-squared, 3 dof); higher values reject "
                    "more closures as ambiguous");
    RADIOSLAM_FIELD(effective_sample_ratio, "", 1e-3, 1,
                    "fraction of the pairs of two windows that counts as independent; lower values inflate "
                    "the covariance");
  }
};

enum class SequenceStatus {
  kAccepted,
  kTooFewMatches,  ///< fewer than three fingerprints of a window have a match in the other
  kNoDistances,    ///< the distance model predicts none
  kResidual,       ///< mean distance from the matches is too large
  kAmbiguous,      ///< another pose fits as well
  kUncertain,      ///< covariance too large, as from straight paths or coarse predictions
  kSuppressed,     ///< a more precise closure overlaps it
};

/// Pose of window i in window j.
struct SequenceFit {
  SequenceStatus status = SequenceStatus::kTooFewMatches;
  double residual_m = 0;  ///< mean distance of i's fingerprints from their matches
  SE2 T_j_i;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of T_j_i Exp(xi); accepted fits only
};

SequenceFit match_windows(const RadioMeasurements& radio, const SequenceWindow& i, const SequenceWindow& j,
                          const SequenceMatchParams& params);

}  // namespace radioslam
