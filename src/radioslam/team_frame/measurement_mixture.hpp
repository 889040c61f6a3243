// Mixture likelihoods of ranges and angles of arrival under multipath and outliers.
//   range:   p = (1 - e) N(r; 0, s^2) + e / span                        e: probability of a false range
//   angle:   p = [(1 - P) + P sum_p pi_p c / s^m exp(-|u - mu_p|^2 / (2 s^2))] / (2 pi or 4 pi)
// with the chord |u - mu_p| between the predicted direction and path p (von Mises in the plane, Fisher in
// space), c / s^m = sqrt(2 pi) / s in the plane and for azimuths alone, 2 / s^2 in space, P the probability
// that one of the paths is direct, pi_p the prior of path p, which grows with its power, and s^2 = sigma^2 +
// (sigma_antenna / distance)^2; without the last term an angle between two adjacent robots would be
// arbitrarily precise. Source: Wi-Closure (Wang et al.) eq. 5 with a term for "no path is direct". The
// weights of the factors are the posteriors of the terms.
//   line of sight: both hold where the direct path is not obstructed. Where it is, a range is the length of a
//            detour, p = (1 - e) D Phi(r / s) + e / span, and an angle p = 1 / (2 pi or 4 pi). D is the
//            density of an obstructed exchange (detour_continuity.hpp), and Phi rejects distances longer than
//            the detour (obstructed_range.hpp). A Markov chain per pair of trajectories connects the
//            measurements of one exchange, and successive ones (sight_chains.hpp). The share of obstructed
//            measurements is estimated from all of them.
//   horizon: an angle between ends further apart than the maximum range also has
//            N(excess; 0, (max_range / 4)^2) / N(0): angles alone are fitted best by robots at infinity,
//            where all directions are parallel.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/graph/pose_graph.hpp"
#include "radioslam/graph/team_graph.hpp"
#include "radioslam/team_frame/line_of_sight/sight_chains.hpp"

namespace radioslam {

// Observed information of mixture measurements, for covariances: the posterior weights of a mixture overstate
// the information, since which term is true remains uncertain. For one measurement with posterior w and
// squared norm s (Louis 1982, one dominant term) the weight becomes w (1 - (1 - w) s) instead of w.

/// Lowers the weights of these ranges and of all bearings accordingly, never below zero.
/// Bearings are also discounted for the angular error that `sigma_antenna_position_m` causes at the current
/// distance. For covariances only: the estimate itself is optimal for the original weights.
template <class Pose>
void use_observed_information(PoseGraph<Pose>& graph, const std::vector<std::size_t>& ranges,
                              double sigma_antenna_position_m);

/// Standard deviation at which the density of an azimuth, or of a direction in space, becomes uniform; larger
/// ones are cut to it.
inline constexpr double kWidestAzimuth_rad = 2.5066282746310002;
inline constexpr double kWidestDirection_rad = 1.4142135623730951;

struct MixtureParams {
  double direct_probability = 0.8;        ///< P
  double false_range_probability = 0.03;  ///< e
  double power_for_double_db = 10;
  double sigma_antenna_position_m = 0.2;
  double max_range_m = 200;  ///< at least the longest measured range
  double obstructed_share = 0.5;
  double sight_time_s = 10;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(direct_probability, "", 0.01, 0.999,
                          "probability that an angle measurement contains the direct path");
    RADIOSLAM_BASIC_FIELD(
        false_range_probability, "", 1e-6, 0.9,
        "probability that a range is not the direct distance; higher values reject more ranges");
    RADIOSLAM_FIELD(power_for_double_db, "dB", 0.1, 1e6,
                    "power difference at which the stronger path is twice as likely to be the direct one");
    RADIOSLAM_BASIC_FIELD(
        sigma_antenna_position_m, "m", 1e-3, 100,
        "standard deviation of antenna positions; divided by the distance, it adds to an angle's error");
    RADIOSLAM_BASIC_FIELD(
        max_range_m, "m", 1, 1e6,
        "distance beyond which angle measurements become unlikely and no relative pose is searched");
    RADIOSLAM_BASIC_FIELD(obstructed_share, "", 0, 0.9,
                          "share of links without line of sight, assumed before it is estimated; their "
                          "ranges are too long, their angles arbitrary; 0: all links are in sight");
    RADIOSLAM_FIELD(sight_time_s, "s", 1e-3, 1e5,
                    "time over which the line of sight between two robots mostly stays as it is; higher "
                    "values make successive links share it more");
  }
};

/// Variance added to that of each measurement while the estimate is coarse.
struct VarianceInflation {
  std::vector<double> ranges_m2;      ///< per range; empty: none
  std::vector<double> bearings_rad2;  ///< per bearing; empty: none
};

/// Priors pi_p of a bearing's paths; their sum is one.
template <class Pose>
std::vector<double> path_priors(const AmbiguousBearing<Pose>& bearing, const MixtureParams& params);

/// The team's ranges and all paths of its bearings as factors of a pose graph with posterior weights.
/// Computed on several threads, with the same bytes for any number of them.
template <class Pose>
class MixtureGraph {
 public:
  MixtureGraph(const TeamGraph<Pose>& team, const MixtureParams& params);

  /// The graph and its values; `ranges` and `bearings` hold the latest weights and sigmas.
  PoseGraph<Pose> graph;

  /// Sets every weight and sigma for the current values, with the inflation scaled by `inflation_scale`. The
  /// factor of a range has the gradient of the mixture of a direct and an obstructed range, so its `range_m`
  /// and `weight` change, too.
  /// Returns the cost: -2 log (L * prior of the obstructed share) plus the squared norms of all other
  /// factors.
  double update_weights(const VarianceInflation& inflation, double inflation_scale);
  /// The same cost; weights and sigmas are unchanged.
  double cost(const VarianceInflation& inflation, double inflation_scale) const;
  /// Sets the share of obstructed measurements to the most likely one at the current values.
  void estimate_obstructed_share(const VarianceInflation& inflation, double inflation_scale);

  double obstructed_share() const { return obstructed_share_; }
  /// Posterior that a range is the direct distance, after update_weights.
  double range_weight(std::size_t range) const { return range_weight_[range]; }
  /// Posterior that one of a bearing's paths is direct, after update_weights.
  double direct_weight(std::size_t bearing) const;
  /// Index of a bearing's first path in graph.bearings.
  std::size_t first_path(std::size_t bearing) const { return first_path_[bearing]; }
  std::size_t bearing_count() const { return first_path_.size() - 1; }

 private:
  struct Densities;
  Densities densities(const VarianceInflation& inflation, double inflation_scale) const;
  void weigh_range(std::size_t range, double inflation_m2, Densities& result) const;
  void weigh_bearing(std::size_t bearing, double inflation_rad2, Densities& result) const;
  void set_range(std::size_t range, const Densities& found, double in_sight);
  void set_bearing(std::size_t bearing, const Densities& found, double in_sight);
  double other_cost() const;
  double log_within_reach(double distance_m) const;
  double log_prior(double share) const;

  MixtureParams params_;
  std::vector<double> range_m_, range_sigma_, range_weight_, path_sigma_, path_prior_;
  std::vector<std::size_t> first_path_;  ///< per bearing, and one past the last
  double span_m_ = 1;
  SightChains chains_;
  double obstructed_share_ = 0;
  std::vector<double> detour_density_;
};

}  // namespace radioslam
