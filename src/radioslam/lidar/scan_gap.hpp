// Detects gaps in a sequence of scans: intervals many times as long as the nominal one, a running mean.
#pragma once

#include <optional>

#include "radioslam/base/stamp.hpp"
#include "radioslam/lidar/lidar_params.hpp"

namespace radioslam {

class ScanGapDetector {
 public:
  explicit ScanGapDetector(const LidarOdometryParams& params) : params_(params) {}

  /// Adds the next scan; whether it is more than `max_lost_scans` nominal intervals after the last one.
  bool is_after_gap(Stamp stamp);

 private:
  LidarOdometryParams params_;
  std::optional<Stamp> newest_;
  double interval_s_ = 0;  ///< nominal; 0: not known yet
};

}  // namespace radioslam
