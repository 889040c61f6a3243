// LiDAR recording of a robot: scans in time order, read from disk on demand, since they do not all fit into
// memory.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "radioslam/base/stamp.hpp"

namespace radioslam {

/// One scan of a laser scanner, in space or in a plane.
struct LidarScan {
  /// In the robot's body frame at the time of each point's measurement, metres. As recorded: coordinates may
  /// be NaN, or zero without a return.
  std::vector<Eigen::Vector3f> points;
  /// Time of every point relative to the scan's stamp, seconds, may be negative; empty if unknown.
  std::vector<float> times_s;
  /// Strength of every return, in the scanner's own units; empty if not recorded.
  std::vector<float> intensities = {};
};

/// A robot's scans.
struct LidarLog {
  std::vector<Stamp> stamps;  ///< strictly increasing
  /// Reads scan k of `stamps`; thread-safe. Throws InputError for a corrupted file.
  std::function<LidarScan(std::size_t k)> read;

  bool empty() const { return stamps.empty(); }
  std::size_t size() const { return stamps.size(); }
};

}  // namespace radioslam
