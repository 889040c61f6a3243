// A scan as it is registered: its surfels, when each was measured, and the motion by which it was unbent.
#pragma once

#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/lidar/scan_points.hpp"
#include "radioslam/lidar/surfel.hpp"

namespace radioslam {

/// A scan on a map.
struct ScanPlace {
  Stamp stamp, middle_stamp;
  SE3 T_map_body, T_map_middle;  ///< at the stamp and in the middle of the sweep
};

/// From the middle of one sweep to that of a later one.
SE3::Tangent twist_between(const ScanPlace& from, const ScanPlace& to);

/// By what motion a scan was unbent: that so far, or one that something else tells.
enum class MotionSource { kSoFar, kTold };

struct ScanSweep {
  Stamp stamp;
  MotionSource source = MotionSource::kSoFar;
  SE3::Tangent twist_per_s = SE3::Tangent::Zero();  ///< by which it was unbent
  std::vector<Surfel> surfels;                      ///< in the body frame at the stamp
  std::vector<float> times_s;                       ///< of the surfels; empty where not known
  double middle_s = 0;

  SE3 T_body_middle() const { return SE3::exp(middle_s * twist_per_s); }
  Stamp middle() const { return {stamp.ns + Stamp::from_seconds(middle_s).ns}; }
  ScanPlace place_at(const SE3& T_map_body) const {
    return {stamp, middle(), T_map_body, T_map_body * T_body_middle()};
  }

  /// By this motion instead.
  void unbend_by(const SE3::Tangent& is_per_s);
};

}  // namespace radioslam
