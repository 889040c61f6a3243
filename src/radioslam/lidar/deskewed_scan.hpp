// A deskewed scan: its surfels, when each was measured, and the motion it was deskewed by.
#pragma once

#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/lidar/deskew.hpp"
#include "radioslam/lidar/surfels/surfel.hpp"

namespace radioslam {

/// A scan's pose on a map.
struct ScanOnMap {
  Stamp stamp, middle_stamp;
  SE3 T_map_body, T_map_middle;  ///< at the stamp and in the middle of the sweep
};

/// Mean twist per second from the middle of one sweep to that of a later one.
SE3::Tangent twist_between(const ScanOnMap& from, const ScanOnMap& to);

struct DeskewedScan {
  Stamp stamp;
  MotionSource source = MotionSource::kConstantVelocity;
  SE3::Tangent twist_per_s = SE3::Tangent::Zero();  ///< by which it was deskewed
  std::vector<Surfel> surfels;                      ///< in the body frame at the stamp
  std::vector<float> times_s;                       ///< of the surfels; empty if unknown
  double middle_s = 0;

  SE3 T_body_middle() const { return SE3::exp(middle_s * twist_per_s); }
  Stamp middle() const { return {stamp.ns + Stamp::from_seconds(middle_s).ns}; }
  ScanOnMap on_map(const SE3& T_map_body) const {
    return {stamp, middle(), T_map_body, T_map_body * T_body_middle()};
  }

  /// Deskews again, by this motion.
  void deskew_with(const SE3::Tangent& is_per_s);
};

}  // namespace radioslam
