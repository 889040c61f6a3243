// Predicts the next scan's pose and the motion during its sweep from the previous scans and the IMU.
//
//   gravity known    the filter (inertial/inertial_filter.hpp) propagates pose and velocity
//   until then       the gyroscope measures rotation; the velocity, constant in the body frame, is that
//                    from the middle of one sweep to the middle of the next
//
// A scan deskewed by a wrong velocity is off at its stamp by the error over half a sweep, but not in its
// middle. Measured between stamps, the error would return in the next velocity with the other sign and never
// decay: v' = v - (dv' - dv) / 2 has the root -1.
// Cost: IMU samples since the filter's state, some hundred products per scan.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/inertial/inertial_filter.hpp"
#include "radioslam/lidar/deskew.hpp"
#include "radioslam/lidar/lidar_odometry.hpp"
#include "radioslam/odometry/inertial_params.hpp"
#include "radioslam/odometry/map_drift.hpp"

namespace radioslam {

/// Motion prior of a scan from sources other than scan matching: recorded odometry or an IMU.
struct MotionPrior {
  MotionSource source = MotionSource::kOdometry;
  std::optional<SE3> T_previous_body;  ///< since the last scan; nothing for the first
  ScanMotion scan_motion;              ///< during the sweep
};

/// From recorded odometry, interpolated between its samples. Nothing if it does not cover both the sweep and
/// the time since `previous`, the last scan's stamp, or if its samples there are more than `max_gap_s`
/// apart.
std::optional<MotionPrior> prior_from_odometry(const Trajectory<SE3>& odometry, std::optional<Stamp> previous,
                                               Stamp stamp, const ScanTimeSpan& time, double max_gap_s);

/// Longest time between successive samples within `begin` to `end`, including the interval at either end; the
/// trajectory covers both.
double max_sample_gap_s(const Trajectory<SE3>& samples, Stamp begin, Stamp end);

class ImuMotionPrior {
 public:
  /// Keeps a pointer to `samples`, which must outlive it.
  ImuMotionPrior(const std::vector<ImuSample>& samples, const InertialParams& params)
      : samples_(&samples), params_(params) {}

  /// Nothing for the first two scans, before the velocity is known, and across gaps in the IMU samples.
  std::optional<MotionPrior> predict(Stamp stamp, const ScanTimeSpan& time) const;

  /// Adds a registered scan, in time order, and the prior it was registered with.
  void add(const ScanPose& scan, const std::optional<MotionPrior>& prior);

 private:
  void align(const ScanPose& scan);
  void update_velocity(const StampedPose<SE3>& middle);
  /// Poses of the body at these non-decreasing times, in an arbitrary common frame.
  std::optional<std::vector<SE3>> predict_path(const std::vector<Stamp>& stamps) const;

  const std::vector<ImuSample>* samples_;
  InertialParams params_;
  std::vector<StampedPose<SE3>> poses_;            ///< until gravity is known
  Stamp state_stamp_;                              ///< of the filter's state
  std::optional<StampedPose<SE3>> last_, middle_;  ///< at the last scan's stamp and in its sweep's middle
  std::optional<Eigen::Vector3d> velocity_mps_;    ///< in the body frame
  std::optional<InertialFilter> filter_;
  std::optional<MapDrift> drift_;  ///< since the filter's state
};

}  // namespace radioslam
