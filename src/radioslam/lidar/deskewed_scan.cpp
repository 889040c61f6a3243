#include "radioslam/lidar/deskewed_scan.hpp"

namespace radioslam {

SE3::Tangent twist_between(const ScanOnMap& from, const ScanOnMap& to) {
  const double dt_s = seconds_between(from.middle_stamp, to.middle_stamp);
  return (from.T_map_middle.inverse() * to.T_map_middle).log() / dt_s;
}

void DeskewedScan::deskew_with(const SE3::Tangent& is_per_s) {
  surfels = re_deskew(surfels, times_s, twist_per_s, is_per_s);
  twist_per_s = is_per_s;
}

}  // namespace radioslam
