// Range biases: constant range errors, one per pair of antennas, estimated with the trajectories and kept
// only if significant. Uncalibrated UWB and WiFi ranges are typically several decimetres too long.
//
// Each pair with enough ranges starts from the centre of the shortest interval that contains half of its
// residuals, which is robust to late paths; errors beyond three sigmas of the prior are detours and do not
// count. Biases and trajectories are then optimized in turn with the ranges' weights, their posterior
// probabilities of being direct. Biases are kept all or none, since single ones trade off against each other
// through the trajectories: they are kept if b^T C^-1 b exceeds the chi-squared quantile for their number. C
// is their joint covariance, inflated by the ranges' overdispersion and correlation time; else hundreds of
// ranges with one reflection would make any small error significant.
// Kept biases get a common prior: its spread is estimated from b and C (empirical Bayes; Morris 1983), its
// mean is a variable, and everything is optimized again, so that pairs whose own bias is unobservable take
// the value of the others. Metres; measured = distance + bias.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/progress.hpp"
#include "radioslam/graph/optimizer.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/joint/team_alignment.hpp"
#include "radioslam/team_frame/measurement_mixture.hpp"

namespace radioslam {

// Statistics of range biases: robust location, correlation time of residuals, and the distribution that
// significant biases are drawn from.

/// Centre of the shortest interval that contains half of the values (shorth).
double middle_of_shortest_half(std::vector<double> values);

/// Number of successive values that count as one: 1 + 2 sum of the autocorrelations, over lags up to the
/// first that is not positive (Geyer 1992). The sequences' own means are subtracted.
double correlation_time(const std::vector<std::vector<double>>& sequences);

/// Normal distribution of the biases, metres.
struct BiasDistribution {
  double mean_m, sigma_m;
};

/// Distribution of the biases b with joint covariance `covariance` [m^2], nothing if they are not significant
/// at `false_alarm_probability`. Uses each bias's own variance v only, since covariances between biases
/// assume ranges without common errors. For b ~ N(m, v + s^2) and w = 1 / v (DerSimonian and Laird 1986):
/// m = sum w b / sum w, and s^2 from
///   E sum w (b - m)^2 = n - 1 + s^2 (sum w - sum w^2 / sum w),
/// at least min_spread_m squared.
std::optional<BiasDistribution> bias_distribution(const std::vector<double>& biases_m,
                                                  const Eigen::MatrixXd& covariance,
                                                  double false_alarm_probability, double min_spread_m);

struct RangeBiasPriorParams {
  double prior_sigma_m = 0.5;
  double false_alarm_probability = 6e-7;
  double min_spread_m = 0.05;
  int min_ranges = 10;
  int max_rounds = 5;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(
        prior_sigma_m, "m", 0, 100,
        "prior standard deviation of the constant range error per antenna pair; 0: no biases are estimated");
    RADIOSLAM_FIELD(false_alarm_probability, "", 1e-9, 0.5,
                    "probability of correcting biases that do not exist (default: five sigma); higher values "
                    "correct smaller ones");
    RADIOSLAM_FIELD(min_spread_m, "m", 1e-4, 100,
                    "lower bound on the estimated spread of biases between antenna pairs");
    RADIOSLAM_FIELD(min_ranges, "", 2, 1e6, "smallest number of ranges of a pair whose bias is estimated");
    RADIOSLAM_FIELD(max_rounds, "", 1, 100,
                    "largest number of rounds of optimizing biases and weights in turn");
  }
};

/// Adds significant biases to the graph's ranges and moves its values to the new optimum; without any, the
/// graph is unchanged. Ranges of closures have no bias. Returns the biases kept, in the order of the pairs.
template <class Pose>
std::vector<RangeBiasResult> estimate_range_biases(
    JointGraph<Pose>& joint, const TeamAlignment<Pose>& alignment, const RangeBiasPriorParams& params,
    const MixtureParams& mixture, const OptimizerParams& optimizer, const Progress& progress = {});

}  // namespace radioslam
