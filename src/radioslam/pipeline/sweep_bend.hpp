// How far a scan's pose may be off since its sweep was unbent by a motion that is known so well only.
//
//   a = (v - v') / T   how the motion changes: twists v, v' of two intervals of length T between scans in a
//                      row, per axis of the body; mean squares, the newest count most
//   by the scans       the motion from the middle of the last sweep to that of this one is half an interval
//                      old: at time t from the middle a point is off by a t T/2, over a sweep of length s by
//                      d = a s T / (4 sqrt 3) rms. The pose lies right in the sweep's middle but for a share
//                      of that; at its stamp, m before the middle, it is off by a m (T - m) / 2
//   by recorded rows   straight from row to row, h apart: d = a h^2 / sqrt 120 rms, at the stamp as well
//   by readings        at their rate: nothing
// A turn along which a sweep all around is bent by d (rms) moves it, too: the mean over the azimuth of points
// at range r is off by sqrt(3) / pi r d.
#pragma once

#include <optional>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/pipeline/swept_way.hpp"

namespace radioslam {

/// What a sweep was unbent by.
enum class SweptBy { kScans, kRecordedRows, kReadings };

class SweepBend {
 public:
  /// `newest_share`: weight of the newest change in the mean. `interval_s`: usually between scans; of scans
  /// that follow each other in less than half of it no motion is told.
  SweepBend(double newest_share, double interval_s) : newest_share_(newest_share), usual_s_(interval_s) {}

  /// The next scan's pose, in any one frame; stamps increase.
  void add(Stamp stamp, const SE3& T_start_body);

  /// The next scan's pose is not told by those before.
  void begin_anew();

  /// Of the pose of a scan in its body frame, per axis [m^2; rad^2]; `rows_s`: between recorded rows;
  /// `range_m`: of its points. Nothing is known to change before the third scan.
  SE3::Tangent variances(SweptBy by, const SweptTime& time, double rows_s, double range_m) const;

 private:
  double newest_share_, usual_s_;
  std::optional<StampedPose<SE3>> last_;
  std::optional<SE3::Tangent> twist_per_s_;
  double interval_s_ = 0;  ///< between the last two scans
  double changes_ = 0;
  SE3::Tangent squares_per_s4_ = SE3::Tangent::Zero();  ///< of a
};

}  // namespace radioslam
