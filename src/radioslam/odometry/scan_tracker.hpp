// Registers a robot's scans one after another and selects keyframes with their clouds, from what its sensors
// have measured so far.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "radioslam/lidar/lidar_odometry.hpp"
#include "radioslam/mission/keyframes.hpp"
#include "radioslam/odometry/imu_motion_prior.hpp"
#include "radioslam/odometry/motion_distortion.hpp"
#include "radioslam/odometry/scan_params.hpp"
#include "radioslam/odometry/scan_tracking.hpp"
#include "radioslam/odometry/sensor_history.hpp"

namespace radioslam {

/// Whether the IMU provides the motion prior.
enum class ImuUse { kNone, kReadings };

class ScanTracker {
 public:
  /// Keeps references, which must outlive it; the history's intervals are known.
  /// The keyframes' clouds are put into `clouds`.
  ScanTracker(const SensorHistory& history, ImuUse by, const ScannerTraits& traits, const ScanParams& params,
              const KeyframeParams& keyframes, CloudStore& clouds);

  /// Registers the next scan. The history covers its sweep, as far as it was measured.
  void add(Stamp stamp, LidarScan scan);

  /// From the next scan on, the IMU has no say.
  void leave_out_imu() { by_ = ImuUse::kNone; }

  const ScanTrajectory& track() const { return track_; }
  /// The last pose becomes a keyframe.
  ScanTrajectory finish() &&;

 private:
  std::optional<MotionPrior> select_prior(Stamp stamp, const ScanTimeSpan& time) const;
  std::optional<SE3> motion_to(Stamp stamp, const std::optional<MotionPrior>& prior) const;
  std::optional<SE3> recorded_motion(Stamp from, Stamp to) const;
  SE3::Jacobian recorded_covariance(Stamp stamp) const;
  SE3::Tangent noise_to_middle(Stamp stamp, const ScanTimeSpan& time) const;
  void add_distortion_covariance(ScanPose& pose, MotionSource source, const ScanTimeSpan& time);
  void take_first_cloud(const std::optional<ScanPyramid>& cloud);
  void forget_start();
  void append(ScanPose pose);
  bool starts_keyframe() const;
  void add_keyframe();

  const SensorHistory& history_;
  ImuUse by_;
  const ScanParams& params_;
  const KeyframeParams& keyframes_;
  CloudStore& clouds_;
  LidarOdometry odometry_;
  ImuMotionPrior imu_prior_;
  DistortionCovariance distortion_;
  SE3::Tangent previous_distortion_ = SE3::Tangent::Zero();  ///< variances of the last pose
  ScanTrajectory track_;
  ScanPyramid last_cloud_;  ///< of the last pose
};

}  // namespace radioslam
