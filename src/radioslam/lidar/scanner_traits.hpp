// Properties of a scanner and its surroundings: planar or spatial, and the map point spacing (a fraction of
// the median range). Determined from up to ten scans, spread over the log.
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
