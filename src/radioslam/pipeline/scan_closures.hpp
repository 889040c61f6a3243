// The loops that robots closed by their own scans, as factors of the joint graph.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/graph/optimizer.hpp"
#include "radioslam/lidar/scan_loops.hpp"
#include "radioslam/pipeline/joint_graph.hpp"

namespace radioslam {

/// A robot's loop closure; nodes of the joint graph stand at both stamps.
struct ScanClosure {
  RobotIndex robot;
  Stamp stamp_i, stamp_j;
  ScanLoop loop;
};

/// Adds the moments of the accepted closures to those of every robot.
void add_closure_moments(const std::vector<ScanClosure>& closures, std::vector<std::vector<Stamp>>& moments);

/// Per closure its factor's place in graph.relative_poses, or -1 where it was rejected.
using ScanTies = std::vector<std::ptrdiff_t>;

/// Adds the accepted closures, each with a loss, and straightens every robot's way by them: poses stay in the
/// frames that they are in.
template <class Pose>
ScanTies add_scan_closures(JointGraph<Pose>& joint, const std::vector<ScanClosure>& closures,
                           const OptimizerParams& optimizer);

/// What became of them in the joint estimate.
template <class Pose>
std::vector<ClosureResult> collect_scan_closures(const JointGraph<Pose>& joint,
                                                 const std::vector<ScanClosure>& closures,
                                                 const ScanTies& ties);

}  // namespace radioslam
