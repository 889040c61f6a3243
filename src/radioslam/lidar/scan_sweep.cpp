#include "radioslam/lidar/scan_sweep.hpp"

namespace radioslam {

SE3::Tangent twist_between(const ScanPlace& from, const ScanPlace& to) {
  const double dt_s = seconds_between(from.middle_stamp, to.middle_stamp);
  return (from.T_map_middle.inverse() * to.T_map_middle).log() / dt_s;
}

void ScanSweep::unbend_by(const SE3::Tangent& is_per_s) {
  surfels = carried_anew(surfels, times_s, twist_per_s, is_per_s);
  twist_per_s = is_per_s;
}

}  // namespace radioslam
