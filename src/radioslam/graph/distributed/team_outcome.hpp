// What an optimization without a centre came to: how far from the central optimum the team was after every
// round, and how much it had sent by then.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/graph/distributed/team_optimization.hpp"
#include "radioslam/graph/optimizer.hpp"
#include "radioslam/graph/team_graph.hpp"

namespace radioslam {

/// A relative gap up to this counts as the optimum.
inline constexpr double kAtOptimum = 1e-3;

/// A team's robots by number, and its graph without priors: they would only choose the frame.
template <class Pose>
struct NumberedTeam {
  std::vector<std::string> names;
  TeamPoses poses;
  PoseGraph<Pose> graph;
};
template <class Pose>
NumberedTeam<Pose> number_robots(const TeamGraph<Pose>& team);

struct TeamOutcome {
  double cost = 0;          ///< of the factors that the team ended up with
  double central_cost = 0;  ///< the lowest cost of these that one computer reaches
  /// Per round, of all factors. Nothing before the robots are in one frame: the cost then lacks the factors
  /// between frames.
  std::vector<std::optional<double>> gaps;
  /// Until the optimum is reached and not left any more; nothing if it is not.
  std::optional<std::size_t> rounds_to_optimum, bytes_to_optimum;
  Traffic traffic;  ///< of all rounds, without the bytes by robot

  double relative_gap() const { return gap_of(cost); }
  /// A cost above the central one, relatively.
  double gap_of(double at_cost) const;
};

/// Cost: two central optimizations.
template <class Pose>
TeamOutcome team_outcome(const NumberedTeam<Pose>& team, const TeamOptimization<Pose>& run,
                         const OptimizerParams& params);

/// If every robot sent its factors to every other one instead: numbers of eight bytes, half of a symmetric
/// information, and two numbers of poses.
template <class Pose>
std::size_t bytes_of_all_graphs(const NumberedTeam<Pose>& team);

}  // namespace radioslam
