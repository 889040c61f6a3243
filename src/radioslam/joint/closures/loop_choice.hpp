// A choice among a team's loops that may be wrong, and its cost: least squares over odometry and loops, with
// every loop truncated,
//   sum of squares of the graph + sum over loops of min(s, gate),
// s the loop's squared norm. The cost is the same function of the solution whichever loops are in it, so that
// any two solutions compare.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "radioslam/graph/graduated.hpp"
#include "radioslam/graph/optimizer.hpp"

namespace radioslam {

/// A team with all of its loops as factors, each in the solution (weight 1) or not (0).
template <class Pose>
struct LoopChoice {
  PoseGraph<Pose> graph;                ///< its last relative poses are the loops
  std::vector<bool> is_odometry;        ///< per relative pose before the loops
  std::vector<Pose> own_shape;          ///< the trajectories, each as it is without the other robots
  std::vector<std::size_t> segment_of;  ///< per pose
  std::vector<double> gates;            ///< per loop: squared norm from which it costs no more
  std::vector<bool> accepted;           ///< per loop

  std::size_t first_loop() const { return graph.relative_poses.size() - gates.size(); }
  const RelativePoseFactor<Pose>& loop(std::size_t k) const { return graph.relative_poses[first_loop() + k]; }
  RelativePoseFactor<Pose>& loop(std::size_t k) { return graph.relative_poses[first_loop() + k]; }
};

/// Sets the loops' weights to what is accepted.
template <class Pose>
void set_weights(LoopChoice<Pose>& choice);

/// The graph's cost, without loops that are not accepted, and every loop that may hold truncated.
template <class Pose>
double truncated_cost(const LoopChoice<Pose>& choice);

enum class Fate { kHolds, kIsDropped };

/// Chooses all loops by a graduated truncated loss, from the present solution, but for those of `decided`,
/// which hold or are dropped; solves the graph with the choice.
template <class Pose>
void choose_gradually(LoopChoice<Pose>& choice, std::span<const std::size_t> decided, Fate fate,
                      const GraduatedParams& params, const OptimizerParams& optimizer,
                      const Progress& progress = {});

}  // namespace radioslam
