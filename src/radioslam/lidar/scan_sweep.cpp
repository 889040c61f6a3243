#include "radioslam/lidar/scan_sweep.hpp"

namespace radioslam {

void ScanSweep::unbend_by(const SE3::Tangent& is_per_s) {
  surfels = carried_anew(surfels, times_s, twist_per_s, is_per_s);
  twist_per_s = is_per_s;
}

}  // namespace radioslam
