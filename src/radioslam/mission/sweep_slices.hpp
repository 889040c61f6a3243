// Sweeps of a turning laser scanner from the slices that its messages are.
//
// Drivers may send a revolution in parts, down to single packets. A slice covers an arc of azimuths about the
// sensor's z axis, and the middle of the arc moves by the same step from slice to slice. Scanners that see
// the same arc each time do not step, and whole sweeps cover more than half a turn each, so neither is taken
// for slices. A sweep is the slices whose middles lie within one revolution from where the first one began;
// a gap in time is as many revolutions as the speed of the turn says, so that slices of different revolutions
// are never joined.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/mission/lidar.hpp"

namespace radioslam {

/// One message of a scanner, points in the sensor's frame.
struct StampedScan {
  Stamp stamp;
  LidarScan scan;
};

/// How slices follow each other.
struct SliceMotion {
  double step_rad = 0;    ///< from slice to slice, in (-pi, pi]
  double rate_radps = 0;  ///< of the turn; 0 if all stamps are equal
  double begin_rad = 0;   ///< azimuth at which the first slice begins
};

/// The motion of slices in time order; nothing if they are not slices of sweeps, or fewer than six. Equal
/// slices have to be left out before. O(n log n) in the number of points.
std::optional<SliceMotion> motion_of_slices(std::span<const StampedScan> slices);

/// Gathers slices into sweeps. A sweep's stamp is the earliest one of its slices, and its points' times are
/// relative to that; points of slices without times have their slice's stamp.
class SweepAssembler {
 public:
  struct Counts {
    std::size_t slices = 0, sweeps = 0;
    std::size_t repeated = 0;  ///< equal to another slice of the sweep, and left out
    std::size_t late = 0;      ///< of sweeps that were complete already, and left out
    std::size_t missing = 0;   ///< gaps in time of less than a revolution
    std::size_t empty = 0;     ///< without points, and left out
  };

  explicit SweepAssembler(const SliceMotion& motion) : motion_(motion) {}

  /// Returns the sweeps that are complete: those before the latest two. Slices may come in any order within
  /// two sweeps.
  std::vector<StampedScan> add(StampedScan slice);
  /// The sweeps that are left.
  std::vector<StampedScan> finish();

  const Counts& counts() const { return counts_; }

 private:
  using Sweeps = std::map<long, std::vector<StampedScan>>;

  long revolution_of(double azimuth_rad, Stamp stamp);
  std::vector<StampedScan> take_before(long revolution);

  SliceMotion motion_;
  bool has_last_ = false;
  double last_rad_ = 0;  ///< unwrapped azimuth since motion_.begin_rad, in the direction of the turn
  Stamp last_stamp_;
  long complete_ = 0;  ///< revolutions before this one have been returned
  Sweeps sweeps_;      ///< by revolution
  Counts counts_;
};

}  // namespace radioslam
