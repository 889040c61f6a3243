// A robot's odometry from its scans as they come, with what else it has measured by then.
//
// A scan is registered once its sweep is over and every source of motion has passed the end of it, or sends
// nothing for the time of two scans. The first kTraitScans scans, or those of kStart_s, wait for each other:
// they show what scanner it is. While the IMU is untested (imu_gate.hpp), the scans are tracked twice,
// without and with it. The former is the estimate until the IMU agrees so far; from then on it is the latter,
// and smoothed with the IMU it is said again as it grows. Either is a change of mind.
// Causal: what is known at a time depends on the samples until then alone, in whatever pieces they came.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/odometry/imu_gate.hpp"
#include "radioslam/odometry/scan_tracker.hpp"
#include "radioslam/odometry/sensor_history.hpp"

namespace radioslam {

/// What a robot measures its motion by.
struct MotionSources {
  bool odometry = false, inertial = false, scans = true;
};

/// Something that whoever watches the robot should know.
struct FrontEndEvent {
  Stamp stamp;
  std::string what;  ///< in words that follow the robot's name
};

/// A robot's scans, tracked to their end.
struct TrackedScans {
  ScanTrajectory track;
  std::optional<ScannerTraits> traits;
  std::optional<std::string> imu_fault;  ///< why the IMU was not used, in words that follow the robot's name
  std::size_t imu_outliers = 0;          ///< samples that were left out
  bool follows_imu = false;              ///< its IMU was trusted to the end
};

class ScanFrontEnd {
 public:
  static constexpr double kStart_s = 3;

  /// `robot`: its properties; its recordings are not read. Keeps references to the parameters and `clouds`,
  /// where the keyframes' clouds are put.
  ScanFrontEnd(const Robot& robot, MotionSources sources, const ScanParams& params,
               const KeyframeParams& keyframes, CloudStore& clouds);
  ScanFrontEnd(const ScanFrontEnd&) = delete;
  ScanFrontEnd& operator=(const ScanFrontEnd&) = delete;

  /// The next sample of any source, in time order.
  void add(const StampedPose<SE3>& odometry);
  void add(const ImuSample& sample);
  void add(Stamp stamp, LidarScan scan);

  /// As known now; nothing before the first scan is registered.
  const ScanTrajectory* track() const;
  /// What scanner it is; nothing before that.
  const std::optional<ScannerTraits>& traits() const { return traits_; }
  /// The poses again, where the robot has changed its mind since the last call.
  std::optional<ScanTrajectory> revised();

  /// No more samples come: registers what waits.
  void register_waiting();
  /// The same; decides what is undecided, and smooths the trajectory if there is an IMU
  /// (lidar_inertial_smoothing.hpp). Call once.
  TrackedScans finish();

  const std::vector<FrontEndEvent>& events() const { return events_; }

 private:
  struct WaitingScan {
    Stamp stamp, end;
    LidarScan scan;
  };

  void advance(Stamp stamp);
  bool has_passed(Stamp end) const;
  void start();
  ScanTrajectory take_track();
  void register_scan(WaitingScan scan);
  void follow_gate();
  bool uses_imu() const { return with_imu_ && (!alone_ || gate_->agrees_so_far()); }
  void say(std::string what) { events_.push_back({now_, std::move(what)}); }

  const ScanParams& params_;
  const KeyframeParams& keyframes_;
  CloudStore& clouds_;
  MotionSources sources_;
  SensorHistory history_;
  ImuOutlierFilter outliers_;
  std::optional<ImuGate> gate_;  ///< of a robot with an IMU
  std::deque<WaitingScan> waiting_;
  Stamp now_, last_odometry_;
  std::optional<ScannerTraits> traits_;
  std::optional<ScanTracker> alone_, with_imu_;  ///< one or, while the IMU is untested, both
  bool has_used_imu_ = false;                    ///< when it was revised
  std::size_t revised_poses_ = 0;                ///< then
  std::vector<FrontEndEvent> events_;
};

}  // namespace radioslam
