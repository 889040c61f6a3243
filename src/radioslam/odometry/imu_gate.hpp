// Whether a robot's IMU may be used, decided on the way (inertial/imu_consistency.hpp).
//
//   untested   until `check_s` of scans, registered without it, agree with it. It agrees so far after two tests
//              without anything wrong
//   trusted    tested again and again on the last `check_s`
//   rejected   two tests one after the other found it wrong; for good
// A test takes place every kTestEvery_s. What is wrong with units or mounting shows in the first of them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/lidar/lidar_odometry.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/odometry/inertial_params.hpp"

namespace radioslam {

enum class ImuTrust { kUntested, kTrusted, kRejected };

class ImuGate {
 public:
  static constexpr double kTestEvery_s = 15;

  explicit ImuGate(const InertialParams& params) : params_(params) {}

  ImuTrust trust() const { return trust_; }
  /// Whether nothing was wrong in the last two tests.
  bool agrees_so_far() const { return right_ >= 2; }
  /// Why it was rejected, in words that follow a robot's name.
  const std::string& reason() const { return reason_; }

  /// Tests the samples against these scans, in time order, if it is time to. Returns whether its trust has
  /// changed.
  bool test(const ScanPoses& scans, const std::vector<ImuSample>& samples);

  /// The last test: what is untested is trusted unless something is wrong.
  void conclude(const ScanPoses& scans, const std::vector<ImuSample>& samples);

  void reject(std::string reason);

 private:
  std::optional<std::string> inconsistency(const ScanPoses& scans,
                                           const std::vector<ImuSample>& samples) const;

  InertialParams params_;
  ImuTrust trust_ = ImuTrust::kUntested;
  std::string reason_;
  std::optional<Stamp> first_, last_test_;
  bool was_wrong_ = false;  ///< in the last test
  int right_ = 0;           ///< tests without anything wrong, one after the other
};

}  // namespace radioslam
