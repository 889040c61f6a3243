// What a log of scans tells of its scanner and of the place: whether it measures in a plane, and how far
// apart the map's points are to lie, a share of the median range. From up to ten scans, spread over the log.
#pragma once

#include "radioslam/lidar/lidar_params.hpp"
#include "radioslam/mission/lidar.hpp"

namespace radioslam {

struct ScannerTraits {
  double spacing_m = 0.25;
  ScannerKind kind = ScannerKind::kSpatial;
};

ScannerTraits scanner_traits(const LidarLog& log, const LidarParams& params);

}  // namespace radioslam
