// LiDAR loop closures within each robot, as factors of the joint graph.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/graph/optimizer.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/odometry/scan_closure.hpp"

namespace radioslam {

/// Adds the stamps of the accepted closures to every robot's node stamps.
void add_closure_stamps(const std::vector<ScanClosure>& closures,
                        std::vector<std::vector<Stamp>>& node_stamps);

/// Adds the accepted closures, each with a loss, and corrects every robot's trajectory by them; poses stay in
/// their frames.
template <class Pose>
void add_scan_closures(JointGraph<Pose>& joint, const std::vector<ScanClosure>& closures,
                       const OptimizerParams& optimizer);

/// Outcomes of the closures in the joint estimate.
template <class Pose>
std::vector<ClosureResult> collect_scan_closures(const JointGraph<Pose>& joint,
                                                 const std::vector<ScanClosure>& closures);

}  // namespace radioslam
