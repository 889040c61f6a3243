// Where the next scan is to be looked for and how it was swept, from the scans so far and the readings since.
//
//   gravity known    the filter (inertial/inertial_filter.hpp) carries pose and velocity on
//   until then       the gyroscope tells the turns; the velocity, constant in the body's frame, is that from
//                    the middle of one sweep to the middle of the next
//
// A scan unbent by a wrong velocity lies wrong at its stamp, by the error of half a sweep, but not at its
// middle. Taken from stamp to stamp the error would return as that of the next velocity with the other sign
// and never decay: v' = v - (dv' - dv) / 2 has the root -1.
// Cost: readings since the filter's state, some hundred products per scan.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/inertial/inertial_filter.hpp"
#include "radioslam/lidar/scan_odometry.hpp"
#include "radioslam/pipeline/inertial_params.hpp"
#include "radioslam/pipeline/map_drift.hpp"
#include "radioslam/pipeline/scan_guess.hpp"

namespace radioslam {

class InertialGuide {
 public:
  /// `samples` must stay.
  InertialGuide(const std::vector<InertialSample>& samples, const InertialParams& params)
      : samples_(&samples), params_(params) {}

  /// Nothing where readings are missing, nor of the first two scans: how fast the body goes is not known.
  std::optional<ScanGuess> guess(Stamp stamp, const SweptTime& time) const;

  /// A registered scan, in time order, and where the body was in the middle of its sweep.
  void add(const ScanPose& scan, const std::optional<ScanGuess>& guess);

 private:
  void align(const ScanPose& scan);
  void take_velocity(const StampedPose<SE3>& middle);
  /// The body at these times, which do not decrease, in any one frame.
  std::optional<std::vector<SE3>> way_through(const std::vector<Stamp>& stamps) const;

  const std::vector<InertialSample>* samples_;
  InertialParams params_;
  std::vector<StampedPose<SE3>> poses_;            ///< until gravity is known
  Stamp state_stamp_;                              ///< the filter's state's
  std::optional<StampedPose<SE3>> last_, middle_;  ///< the last scan's, and of its sweep's middle
  std::optional<Eigen::Vector3d> velocity_mps_;    ///< of the body, in its frame
  std::optional<InertialFilter> filter_;
  std::optional<MapDrift> drift_;  ///< since the filter's state
};

}  // namespace radioslam
