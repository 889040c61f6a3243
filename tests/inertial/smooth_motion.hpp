// Smooth analytic motions, and the samples of an IMU along them.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/inertial/preintegration.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam::test {

/// Amplitudes and rates of a motion.
struct Liveliness {
  double way_m = 1;            ///< amplitude of the translational sines, per axis
  double turn_rad = 0.5;       ///< amplitude of the sines in yaw, pitch and roll
  double fastest_radps = 3;    ///< largest angular frequency of the sines
  double speed_mps = 1;        ///< of the linear motion that the sines are added to
  double turning_radps = 0.2;  ///< largest constant rate of yaw, pitch and roll
};

/// Each of x, y, z, yaw, pitch, roll a straight line plus three sines.
class SmoothMotion {
 public:
  SmoothMotion(Rng rng, const Liveliness& of) {
    for (int axis = 0; axis < 6; ++axis) {
      lines_[index(axis)] =
          axis < 3 ? rng.normal(0, of.speed_mps) : rng.uniform(-of.turning_radps, of.turning_radps);
      for (Sine& sine : sines_[index(axis)])
        sine = {rng.uniform(0.3, 1) * (axis < 3 ? of.way_m : of.turn_rad) / kSines,
                rng.uniform(0.2, 1) * of.fastest_radps, rng.uniform(0, 6.28)};
    }
  }

  /// Adds to the random linear motion.
  void add_course(const Eigen::Vector3d& velocity_mps) {
    for (int axis = 0; axis < 3; ++axis) lines_[index(axis)] += velocity_mps[axis];
  }

  SE3 pose(double t) const {
    const Eigen::Quaterniond R = Eigen::AngleAxisd(value(3, t), Eigen::Vector3d::UnitZ()) *
                                 Eigen::AngleAxisd(value(4, t), Eigen::Vector3d::UnitY()) *
                                 Eigen::AngleAxisd(value(5, t), Eigen::Vector3d::UnitX());
    return {{value(0, t), value(1, t), value(2, t)}, R};
  }
  Eigen::Vector3d velocity(double t) const { return {slope(0, t), slope(1, t), slope(2, t)}; }
  Eigen::Vector3d acceleration(double t) const { return {bend(0, t), bend(1, t), bend(2, t)}; }
  /// In the body frame: w = E(pitch, roll) [roll', pitch', yaw'].
  Eigen::Vector3d angular_rate(double t) const {
    const double pitch = value(4, t), roll = value(5, t);
    const double yaw_rate = slope(3, t), pitch_rate = slope(4, t), roll_rate = slope(5, t);
    return {roll_rate - yaw_rate * std::sin(pitch),
            pitch_rate * std::cos(roll) + yaw_rate * std::sin(roll) * std::cos(pitch),
            -pitch_rate * std::sin(roll) + yaw_rate * std::cos(roll) * std::cos(pitch)};
  }
  InertialState state(double t) const { return {pose(t), velocity(t), {}}; }
  ImuSample reading(double t, const Eigen::Vector3d& gravity) const {
    return {Stamp::from_seconds(t), pose(t).rotation().conjugate() * (acceleration(t) - gravity),
            angular_rate(t)};
  }

 private:
  static constexpr int kSines = 3;
  struct Sine {
    double size = 0, frequency = 0, phase = 0;
  };
  static std::size_t index(int axis) { return static_cast<std::size_t>(axis); }
  double value(int axis, double t) const {
    double sum = lines_[index(axis)] * t;
    for (const Sine& s : sines_[index(axis)]) sum += s.size * std::sin(s.frequency * t + s.phase);
    return sum;
  }
  double slope(int axis, double t) const {
    double sum = lines_[index(axis)];
    for (const Sine& s : sines_[index(axis)])
      sum += s.size * s.frequency * std::cos(s.frequency * t + s.phase);
    return sum;
  }
  double bend(int axis, double t) const {
    double sum = 0;
    for (const Sine& s : sines_[index(axis)])
      sum -= s.size * s.frequency * s.frequency * std::sin(s.frequency * t + s.phase);
    return sum;
  }

  std::array<double, 6> lines_{};
  std::array<std::array<Sine, kSines>, 6> sines_{};
};

/// Three independent normal variates.
inline Eigen::Vector3d normal_vector(Rng& rng, double sigma) {
  const double x = rng.normal(0, sigma), y = rng.normal(0, sigma), z = rng.normal(0, sigma);
  return {x, y, z};
}

/// Error-free samples at `rate_hz`, from 0 to `end_s`.
template <class Motion>
std::vector<ImuSample> perfect_readings(const Motion& motion, double end_s, double rate_hz,
                                        const ImuNoiseParams& params) {
  std::vector<ImuSample> samples;
  const auto count = static_cast<int>(std::lround(end_s * rate_hz));
  for (int k = 0; k <= count; ++k) samples.push_back(motion.reading(k / rate_hz, params.gravity()));
  return samples;
}

/// Adds white noise and a bias that performs a random walk from `bias`. Returns the bias at each sample.
inline std::vector<InertialBias> add_errors(std::vector<ImuSample>& samples, InertialBias bias,
                                            double rate_hz, const ImuNoiseParams& params, Rng& rng) {
  std::vector<InertialBias> biases;
  for (ImuSample& sample : samples) {
    biases.push_back(bias);
    sample.angular_rate_radps +=
        bias.gyroscope_radps + normal_vector(rng, params.gyroscope_noise * std::sqrt(rate_hz));
    sample.specific_force_mps2 +=
        bias.accelerometer_mps2 + normal_vector(rng, params.accelerometer_noise * std::sqrt(rate_hz));
    bias.gyroscope_radps += normal_vector(rng, params.gyroscope_walk / std::sqrt(rate_hz));
    bias.accelerometer_mps2 += normal_vector(rng, params.accelerometer_walk / std::sqrt(rate_hz));
  }
  return biases;
}

}  // namespace radioslam::test
