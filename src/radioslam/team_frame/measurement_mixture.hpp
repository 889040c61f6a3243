// What a range or an angle of arrival says when it may be wrong.
//   range:   p = (1 - e) N(r; 0, s^2) + e / span                        e: share of false ranges
//   angle:   p = [(1 - P) + P sum_p pi_p c / s^m exp(-|u - mu_p|^2 / (2 s^2))] / (2 pi or 4 pi)
// with the chord |u - mu_p| between the predicted direction and path p (von Mises, or Fisher in space),
// c / s^m = sqrt(2 pi) / s in the plane and 2 / s^2 in space, P the probability that one of the paths is
// direct, s^2 = sigma^2 + (sigma_place / distance)^2, without which an angle between two robots side by side
// would be known without bound, and pi_p its prior among them, which grows with the path's power. Source:
// Wi-Closure eq. 5 with the term for "no path is direct". The expected weights are the posteriors of the
// terms.
//   horizon: an angle between ends further apart than the radio reaches also has
//            N(excess; 0, (reach / 4)^2) / N(0): angles alone are fitted best by teams far away, where all
//            directions are parallel.
#pragma once

#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/graph/team_graph.hpp"

namespace radioslam {

/// Wider than this a direction says nothing: its density is the uniform one.
template <class Pose>
inline constexpr double kWidest_rad = Pose::kDim == 2 ? 2.5066282746310002 : 1.4142135623730951;

struct MixtureParams {
  double direct_probability = 0.8;        ///< P
  double false_range_probability = 0.03;  ///< e
  double power_for_double_db = 10;        ///< a path this much stronger is twice as likely direct
  double sigma_place_m = 0.2;             ///< of the ends' antennas in their bodies: turns near directions
  double reach_m = 200;                   ///< of the radio; the longest measured range where that is longer

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(
        Field{"direct_probability", "", 0.01, 0.999, "share of angle measurements that hold the direct path"},
        self.direct_probability);
    visit(Field{"false_range_probability", "", 1e-6, 0.9, "share of ranges that are not the direct distance"},
          self.false_range_probability);
    visit(Field{"power_for_double_db", "dB", 0.1, 1e6, "a path this much stronger is twice as likely direct"},
          self.power_for_double_db);
    visit(Field{"sigma_place_m", "m", 1e-3, 100,
                "error of the antennas' places: over the distance, it adds to an angle's error"},
          self.sigma_place_m);
    visit(Field{"reach_m", "m", 1, 1e6, "angles are hardly measured, and no distance is tried, beyond this"},
          self.reach_m);
  }
};

/// Variance that is added to every measurement's own while the estimate is still coarse.
struct Inflation {
  std::vector<double> ranges_m2;      ///< per range; empty: none
  std::vector<double> bearings_rad2;  ///< per bearing; empty: none
};

/// The probability that a range with this error is the direct distance. `span_m`: of all ranges.
double range_posterior(double error_m, double sigma_m, double span_m, const MixtureParams& params);

/// Priors pi_p of a bearing's paths; they sum to one.
template <class Pose>
std::vector<double> path_priors(const AmbiguousBearing<Pose>& bearing, const MixtureParams& params);

/// The team's ranges and all paths of its bearings as factors of one pose graph, reweighted again and again.
template <class Pose>
class MixtureGraph {
 public:
  MixtureGraph(const TeamGraph<Pose>& team, const MixtureParams& params);

  /// The graph with values; `ranges` and `bearings` carry the last weights and sigmas.
  PoseGraph<Pose> graph;

  /// Sets every weight and sigma for the present values, with `share` of the inflation. Returns the cost
  /// -2 log L: of the mixture plus the squared norms of all other factors.
  double reweigh(const Inflation& inflation, double share);
  /// The same cost without touching weights and sigmas.
  double cost(const Inflation& inflation, double share) const;

  /// Posterior that a path of bearing k is direct (their sum), after reweigh.
  double direct_weight(std::size_t bearing) const;
  /// Index of a bearing's first path in graph.bearings.
  std::size_t first_path(std::size_t bearing) const { return first_path_[bearing]; }
  std::size_t bearing_count() const { return first_path_.size() - 1; }

 private:
  template <class Visit>
  double visit_measurements(const Inflation& inflation, double share, Visit&& visit) const;
  double other_cost() const;
  double distance_m(std::size_t path) const;
  double log_within_reach(double distance_m) const;

  MixtureParams params_;
  std::vector<double> range_sigma_, path_sigma_, path_prior_;
  std::vector<std::size_t> first_path_;  ///< and one past the last
  double span_m_ = 1;
};

}  // namespace radioslam
