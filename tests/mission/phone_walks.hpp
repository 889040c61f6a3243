// Simulated phone sensors for known walking trajectories.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "radioslam/base/random.hpp"
#include "radioslam/mission/phone_motion.hpp"

namespace radioslam::test {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kSampleTime_s = 0.02;
inline constexpr std::int64_t kWalkBegin_ns = 1'574'242'584'992'000'000;  // since the Unix epoch

inline Stamp walk_stamp(double t_s) { return {kWalkBegin_ns + Stamp::from_seconds(t_s).ns}; }

/// A walking trajectory as the functions of time that phone sensors measure.
struct KnownWalk {
  double duration_s = 30;
  std::function<double(double)> heading_rad = [](double) { return 0.0; };    ///< from east
  std::function<double(double)> vertical_mps2 = [](double) { return 0.0; };  ///< upward acceleration
  /// Orientation of the phone in the hand: device to a frame with y forward and z up.
  Eigen::Quaterniond R_hand_device = Eigen::Quaterniond::Identity();
  Eigen::Vector3d gyroscope_bias_radps = Eigen::Vector3d::Zero();
  std::function<double(double)> compass_error_rad = [](double) { return 0.0; };
  double sigma_force_mps2 = 0;
  double sigma_rate_radps = 0;
};

/// Steps of `amplitude_mps2` at `rate_hz` between two times, with a peak in the middle of every period.
inline std::function<double(double)> steps_between(double begin_s, double end_s, double rate_hz,
                                                   double amplitude_mps2) {
  return [=](double t) {
    if (t < begin_s || t > end_s) return 0.0;
    return -amplitude_mps2 * std::cos(2 * kPi * rate_hz * (t - begin_s));
  };
}

/// Heading from `before_rad` to `after_rad` at a constant rate for one second from `t_s`.
inline std::function<double(double)> turn_at(double t_s, double before_rad, double after_rad) {
  return [=](double t) { return before_rad + (after_rad - before_rad) * std::clamp(t - t_s, 0.0, 1.0); };
}

inline Eigen::Vector3d normal_vector(Rng& rng, double sigma) {
  return {rng.normal(0, sigma), rng.normal(0, sigma), rng.normal(0, sigma)};
}

/// Sensor samples at 50 Hz; `seed` determines the noise.
inline PhoneMotion recorded(const KnownWalk& walk, std::uint64_t seed = 1) {
  constexpr double kGravity = 9.80665;
  constexpr double kHalf = 1e-4;  // of the interval for derivatives
  Rng rng(seed);
  PhoneMotion motion;
  for (int i = 0; i * kSampleTime_s <= walk.duration_s; ++i) {
    const double t = i * kSampleTime_s;
    const Stamp stamp = walk_stamp(t);
    const Eigen::Quaterniond R_device_hand = walk.R_hand_device.inverse();
    const double rate = (walk.heading_rad(t + kHalf) - walk.heading_rad(t - kHalf)) / (2 * kHalf);
    const Eigen::Vector3d up = R_device_hand * Eigen::Vector3d::UnitZ();
    motion.specific_force_mps2.push_back(
        {stamp, (kGravity + walk.vertical_mps2(t)) * up + normal_vector(rng, walk.sigma_force_mps2)});
    motion.angular_rate_radps.push_back(
        {stamp, rate * up + walk.gyroscope_bias_radps + normal_vector(rng, walk.sigma_rate_radps)});
    const double yaw = walk.heading_rad(t) + walk.compass_error_rad(t) - kPi / 2;  // y forward
    motion.orientation.push_back(
        {stamp, Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * walk.R_hand_device});
  }
  return motion;
}

/// Screen tilted towards the walker and slightly to the side.
inline Eigen::Quaterniond tilted_hand() {
  return Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY());
}

}  // namespace radioslam::test
