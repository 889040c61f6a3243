// How far a scan's pose may be off since its sweep was unbent by a motion that is known so well only.
//
//   a = (v - v') / T      how the motion changes: twists v, v' of two intervals of length T between scans in
//   a
//                         row, per axis of the body; mean squares, the newest count most
//   by the scans          the motion from the middle of the last sweep to that of this one is half an
//   interval
//                         old: at time t from the middle a point is off by a t T/2, over a sweep of length s
//                         by a s T / (4 sqrt 3) rms
//   by recorded rows      straight from row to row, h apart: by a h^2 / sqrt 120 rms
//   by readings           at their rate: by nothing
// A turn by which a sweep is bent moves the pose, too, by as much as points at their usual range. What part
// of that a pose takes on depends on where in the sweep its surfaces lie; all of it is assumed.
#pragma once

#include <optional>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"

namespace radioslam {

/// What a sweep was unbent by.
enum class SweptBy { kScans, kRecordedRows, kReadings };

class SweepBend {
 public:
  /// `newest_share`: weight of the newest change in the mean.
  explicit SweepBend(double newest_share) : newest_share_(newest_share) {}

  /// The next scan's pose, in any one frame; stamps increase.
  void add(Stamp stamp, const SE3& T_start_body);

  /// Of the pose of a scan in its body frame, per axis [m^2; rad^2]; `over_s`: the sweep's length, or the
  /// time between rows; `range_m`: of its points. Nothing is known to change before the third scan.
  SE3::Tangent variances(SweptBy by, double over_s, double range_m) const;

 private:
  double newest_share_;
  std::optional<StampedPose<SE3>> last_;
  std::optional<SE3::Tangent> twist_per_s_;
  double interval_s_ = 0;                               ///< between the last two scans
  SE3::Tangent squares_per_s4_ = SE3::Tangent::Zero();  ///< of a
};

}  // namespace radioslam
