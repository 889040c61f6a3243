// What a robot's sensors have measured so far, as far as its scans still need it.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// The nominal interval of samples on the way: the median of the last ones. 0 before the second sample.
class NominalInterval {
 public:
  void add(Stamp stamp);
  double seconds() const { return median_s_; }

 private:
  static constexpr std::size_t kLast = 65;

  std::optional<Stamp> last_;
  std::deque<double> intervals_s_;
  double median_s_ = 0;
};

class SensorHistory {
 public:
  /// Of `robot` without its recordings; `robot.odometry_noise` may have the noise of all steps to come.
  explicit SensorHistory(Robot robot);

  void add(const StampedPose<SE3>& odometry);
  void add(Stamp scan) { scan_interval_.add(scan); }
  /// Noise of the step to the sample that comes next.
  void add(const OdometryStepNoise& step) { robot_.odometry_noise.steps.push_back(step); }
  /// Samples of the IMU, to be appended to.
  std::vector<ImuSample>& inertial() { return robot_.inertial; }
  const std::vector<ImuSample>& inertial() const { return robot_.inertial; }

  /// The robot with its odometry since the last one at or before forget_before(), and all IMU samples.
  const Robot& robot() const { return robot_; }
  /// Brings robot().odometry up to date.
  void update();
  /// Odometry before `stamp` is needed no more.
  void forget_before(Stamp stamp);

  /// Whether the robot has moved as fast before, by its odometry.
  bool has_been_as_fast(const SE3& motion, double duration_s) const;

  double sample_interval_s() const { return sample_interval_.seconds(); }
  double scan_interval_s() const { return scan_interval_.seconds(); }

 private:
  Robot robot_;
  std::deque<StampedPose<SE3>> rows_;
  NominalInterval sample_interval_, scan_interval_;
  double fastest_mps_ = 0, fastest_radps_ = 0;
};

}  // namespace radioslam
