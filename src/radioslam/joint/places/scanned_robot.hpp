// A robot's scanned keyframes in the joint graph, with descriptors by which places are recognised.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/odometry/scan_stage.hpp"
#include "radioslam/places/keyframe_contexts.hpp"
#include "radioslam/places/loops/expected_place.hpp"
#include "radioslam/places/scan_context_index.hpp"
#include "radioslam/records/scanned_records.hpp"

namespace radioslam {

/// Of one robot's scanned keyframes.
struct RobotDescriptors {
  double range_m = 0;
  std::optional<ScanContextIndex> index = {};  ///< nothing without keyframes
};

/// Descriptors of all robots by which places are recognised. They depend on the recordings alone.
struct TeamDescriptors {
  std::vector<RobotDescriptors> robots;
};

/// Those of robots with the same kind of scanner have one range and can be compared. A planar scanner sees
/// little at once: its grids are of all scans within `submap_m`.
TeamDescriptors describe_places(const MeasuredScans& scans, const PlaceDescriptorParams& params,
                                double submap_m);

/// These descriptors as records, one a metre, in steps of a 15th of the highest bin.
std::vector<ScannedPlace> scanned_places(const MeasuredScans& scans, const PlaceDescriptorParams& params,
                                         double submap_m);

/// A closure that was said in a log.
ScanLoop loop_of(const ScannedClosure& said);

/// A robot's keyframes as its scans place them. All must outlive the result. `contexts`: null where places
/// that look alike are not searched.
PlacedKeyframes placed_keyframes(const ScanOdometry& scans, const std::vector<double>& path_m,
                                 const ScanContextIndex* contexts = nullptr);

/// Per keyframe: its node, the last keyframe of the graph before it; the motion from there; its descriptor.
struct ScannedRobot {
  const ScanOdometry* scans = nullptr;
  std::vector<double> path_m = {};
  std::vector<std::size_t> keyframes = {};  ///< of the joint graph
  std::vector<PoseId> nodes = {};
  std::vector<SE3> T_node_scan = {};
  const ScanContextIndex* contexts = nullptr;  ///< null without keyframes
  double context_range_m = 0;

  std::size_t size() const { return nodes.size(); }
  ScannerKind kind() const { return scans->keyframes.kind; }
  const StoredCloud& cloud(std::size_t k) const { return scans->keyframes.clouds[k]; }
  bool has_cloud(std::size_t k) const { return !cloud(k).empty(); }
  bool has_any_cloud() const {
    for (std::size_t k = 0; k < size(); ++k)
      if (has_cloud(k)) return true;
    return false;
  }
  PlacedKeyframes placed() const { return placed_keyframes(*scans, path_m, contexts); }

  /// Keyframes with a scan, at least `stride_m` apart.
  std::vector<std::size_t> strides(double stride_m) const {
    std::vector<std::size_t> result;
    double next_m = 0;
    for (std::size_t k = 0; k < size(); ++k) {
      if (path_m[k] < next_m || !has_cloud(k)) continue;
      next_m = path_m[k] + stride_m;
      result.push_back(k);
    }
    return result;
  }
};

ScannedRobot scanned_robot(const ScanOdometry& scans, const RobotDescriptors& descriptors,
                           const RobotVariables& variables, const Trajectory<SE3>& odometry);

}  // namespace radioslam
