// LiDAR loop closures within each robot, as factors of the joint graph.
#pragma once

#include <vector>

#include "radioslam/graph/optimizer.hpp"
#include "radioslam/joint/closures/closure.hpp"
#include "radioslam/odometry/scan_closure.hpp"

namespace radioslam {

/// In their order; the statistic of those that scan matching rejected is the inlier ratio.
std::vector<Closure> closures_of_scans(const std::vector<ScanClosure>& scans);

/// Adds the stamps of the accepted closures to every robot's node stamps.
void add_closure_stamps(const std::vector<Closure>& closures, std::vector<std::vector<Stamp>>& node_stamps);

/// Adds the accepted closures of robots with themselves, each with a loss, and corrects every robot's
/// trajectory by them; poses stay in their frames.
template <class Pose>
void add_scan_closures(JointGraph<Pose>& joint, const std::vector<Closure>& closures,
                       const OptimizerParams& optimizer);

}  // namespace radioslam
