// Properties of every scan that a reader returns.
#pragma once

#include "fuzzed.hpp"
#include "radioslam/base/check.hpp"
#include "radioslam/mission/lidar.hpp"

namespace radioslam {

inline void check_scan(const LidarScan& scan) {
  RADIOSLAM_CHECK(scan.times_s.empty() || scan.times_s.size() == scan.points.size(),
                  "a time per point or none");
}

}  // namespace radioslam
