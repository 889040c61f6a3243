// Line of sight between the ends of successive measurements: for each pair of trajectories, or a trajectory
// and a point, a Markov chain in continuous time with the states in sight and obstructed. Over a gap of t
// seconds, P(z' = z) = share(z) + (1 - share(z)) exp(-t / T), with the stationary share of each state and the
// correlation time T. Measurements of one exchange share their state, and so, mostly, do successive ones. The
// posterior of every measurement follows from a forward and a backward pass (Baum et al. 1970). Chains are
// passed on several threads, their sums taken in order.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/graph/team_graph.hpp"

namespace radioslam {

/// Densities of a measurement in either state; at least one is positive.
struct SightDensities {
  double in_sight = 1, obstructed = 1;
};

struct TimedLink {
  Stamp stamp;
  std::size_t measurement = 0;  ///< in `graph.ranges`, then `bearings`
};

/// Measurements between two trajectories, or a trajectory and a point, in the order of their times.
struct PairLinks {
  bool is_between_robots = true;
  std::vector<TimedLink> links;
};
template <class Pose>
std::vector<PairLinks> links_by_pair(const TeamGraph<Pose>& team);

class SightChains {
 public:
  /// `correlation_time_s`: T, above zero.
  template <class Pose>
  SightChains(const TeamGraph<Pose>& team, double correlation_time_s);

  /// Log likelihood of all measurements; their densities are in the same order. `obstructed_share`: in [0,
  /// 1).
  double log_likelihood(const std::vector<SightDensities>& densities, double obstructed_share) const;

  /// The same, and each measurement's posterior probability of being in sight.
  double smooth(const std::vector<SightDensities>& densities, double obstructed_share,
                std::vector<double>& in_sight) const;

 private:
  struct Link {
    std::size_t measurement = 0;
    double forgotten = 0;  ///< 1 - exp(-gap / T), with the gap since the preceding one; 0 for the first
  };
  struct Forward;

  static double pass_forward(const std::vector<Link>& chain, const std::vector<SightDensities>& densities,
                             double obstructed_share, std::vector<Forward>* passed);
  static void pass_backward(const std::vector<Link>& chain, const std::vector<SightDensities>& densities,
                            double obstructed_share, const std::vector<Forward>& passed,
                            std::vector<double>& in_sight);

  std::vector<std::vector<Link>> chains_;
};

}  // namespace radioslam
