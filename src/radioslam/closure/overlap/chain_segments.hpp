// Divides the trajectories of a pose graph into segments whose inner poses have odometry factors only.
// A segment ends at a pose with another factor, at a step with singular information, at a second factor
// between the same poses, at a change of drift, and at poses that fix the gauge.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/graph/gauge.hpp"
#include "radioslam/graph/pose_graph.hpp"

namespace radioslam {

/// The poses of one robot in a graph.
struct ChainOfPoses {
  std::vector<PoseId> poses;          ///< in time order, with a RelativePoseFactor from each to the next
  std::vector<std::size_t> searched;  ///< indices into `poses` of those to compare, increasing; empty: all
};

/// Odometry from one pose of a chain to the next: xi_j = Ad(T_j^-1 T_i) xi_i + drift_effect * drift + noise.
template <class Pose>
struct ChainStep {
  typename Pose::Jacobian covariance;
  Eigen::Matrix<double, Pose::kDof, 2> drift_effect;
  DriftId drift{};
};

/// Poses [first, last] of a chain; only the ends are in the skeleton.
struct ChainSegment {
  std::size_t first = 0, last = 0;
  DriftId drift{};
};

template <class Pose>
struct SkeletonChain {
  std::vector<std::optional<ChainStep<Pose>>>
      steps;                           ///< from pose k to k + 1; none where odometry is singular or missing
  std::vector<ChainSegment> segments;  ///< in order; they cover all poses
};

template <class Pose>
struct ChainSegments {
  std::vector<SkeletonChain<Pose>> chains;
  std::vector<bool> is_end;   ///< per pose of the graph: an end of segments, or in no chain
  std::vector<bool> is_step;  ///< per relative pose factor: odometry of a chain
  Gauge<Pose> gauge;
};

/// The chains must consist of poses of the graph, each at most once.
template <class Pose>
ChainSegments<Pose> divide_into_segments(const PoseGraph<Pose>& graph,
                                         const std::vector<ChainOfPoses>& chains);

}  // namespace radioslam
