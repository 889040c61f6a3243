// What a robot's laser scanner recorded: scans in time order, each read when it is asked for, for a drive's
// scans do not fit into memory at once.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "radioslam/base/stamp.hpp"

namespace radioslam {

/// One sweep of a laser scanner, of all around or of a plane.
struct LidarScan {
  /// In the robot's body frame, each at the time of its own measurement; metres. As recorded: coordinates may
  /// be NaN, or zero where nothing came back.
  std::vector<Eigen::Vector3f> points;
  /// Of every point since the scan's stamp, seconds, may be negative; empty where not known.
  std::vector<float> times_s;
};

/// A robot's scans.
struct LidarLog {
  std::vector<Stamp> stamps;  ///< strictly increasing
  /// Scan k of `stamps`; may be called from several threads. Throws InputError where a file is spoilt.
  std::function<LidarScan(std::size_t k)> read;

  bool empty() const { return stamps.empty(); }
  std::size_t size() const { return stamps.size(); }
};

}  // namespace radioslam
