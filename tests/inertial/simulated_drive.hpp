// Simulated drive with poses by scan matching on a drifting map and IMU samples, with errors as stated.
#pragma once

#include <utility>
#include <vector>

#include "inertial/smooth_motion.hpp"
#include "radioslam/geometry/so3.hpp"
#include "radioslam/inertial/inertial_smoother.hpp"

namespace radioslam::test {

/// Length of the drive, and accuracy of the scans.
struct DrivePlan {
  double duration_s = 4;
  double states_hz = 10, readings_hz = 200;
  double sigma_position_m = 0.02, sigma_rotation_rad = 0.003;  ///< of one pose by scan matching
  double sigma_drift_m = 0.01, sigma_drift_rad = 0.002;        ///< of the map, from one state to the next
  double corridor_begin_s = 0, corridor_end_s = 0;  ///< scans observe no motion along the world's x
  Liveliness liveliness{1, 0.3, 2, 0.5, 0.1};
  Eigen::Vector3d course_mps = Eigen::Vector3d::Zero();
};

struct SimulatedDrive {
  InertialDrive drive;
  std::vector<ImuSample> samples;
  std::vector<InertialState> truth;  ///< at the drive's stamps
};

constexpr double kNotSeen_m = 100;      ///< deviation of a pose along the corridor
constexpr double kCorridorDrift_m = 1;  ///< of the map along it, from one state to the next

inline SE3::Jacobian diagonal_covariance(double sigma_m, double sigma_rad, const Eigen::Vector3d& more_m) {
  SE3::Jacobian covariance = SE3::Jacobian::Zero();
  covariance.diagonal().head<3>().setConstant(sigma_m * sigma_m);
  covariance.diagonal().tail<3>().setConstant(sigma_rad * sigma_rad);
  covariance.topLeftCorner<3, 3>() += more_m * more_m.transpose();
  return covariance;
}

/// Pose of the world on the drifting map. Where scans do not observe motion along `along` (in the body frame,
/// zero elsewhere), the map moves along with the body.
struct GrowingMap {
  SE3 T_map_world;

  void grow(const SE3& from, const SE3& to, const Eigen::Vector3d& along, const DrivePlan& plan, Rng& rng) {
    SE3::Tangent drift;
    drift << normal_vector(rng, plan.sigma_drift_m), normal_vector(rng, plan.sigma_drift_rad);
    drift.head<3>() -= along * along.dot((from.inverse() * to).translation());
    T_map_world = T_map_world * from * SE3::exp(drift) * from.inverse();
  }
};

/// Pose on the map by scan matching: noisy, and without information along `along` in the body frame.
inline MapPose scan_pose(const SE3& T_map_body, const DrivePlan& plan, const Eigen::Vector3d& along,
                         Rng& rng) {
  SE3::Tangent noise;
  noise << normal_vector(rng, plan.sigma_position_m), normal_vector(rng, plan.sigma_rotation_rad);
  noise.head<3>() -= along * along.dot(noise.head<3>());
  return {T_map_body * SE3::exp(noise),
          diagonal_covariance(plan.sigma_position_m, plan.sigma_rotation_rad, kNotSeen_m * along).inverse()};
}

/// The initial guess is drawn around the truth with the smoother's prior sigmas.
inline SimulatedDrive simulate_drive(const DrivePlan& plan, const ImuNoiseParams& noise,
                                     const InertialSmootherParams& smoother, Rng rng) {
  SmoothMotion motion(rng.split("motion"), plan.liveliness);
  motion.add_course(plan.course_mps);
  SimulatedDrive sim;
  sim.samples = perfect_readings(motion, plan.duration_s + 0.1, plan.readings_hz, noise);
  const InertialBias bias{normal_vector(rng, noise.sigma_gyroscope_bias_radps),
                          normal_vector(rng, noise.sigma_accelerometer_bias_mps2)};
  const auto biases = add_errors(sim.samples, bias, plan.readings_hz, noise, rng);
  GrowingMap map{SE3({3, -2, 1}, so3_exp({0.1, -0.2, 0.8}))};
  for (int k = 0; k <= std::lround(plan.duration_s * plan.states_hz); ++k) {
    const double t = k / plan.states_hz;
    sim.drive.stamps.push_back(Stamp::from_seconds(t));
    sim.truth.push_back(motion.state(t));
    sim.truth.back().bias = biases[static_cast<std::size_t>(std::lround(t * plan.readings_hz))];
    const SE3& to = sim.truth.back().T_world_body;
    const auto along = [&](const SE3& T) {
      const bool in_corridor = plan.corridor_begin_s < t && t <= plan.corridor_end_s;
      return Eigen::Vector3d(in_corridor ? T.rotation().conjugate() * Eigen::Vector3d::UnitX()
                                         : Eigen::Vector3d(Eigen::Vector3d::Zero()));
    };
    if (k > 0) {
      const SE3& from = sim.truth[sim.truth.size() - 2].T_world_body;
      map.grow(from, to, along(from), plan, rng);
      sim.drive.map_drifts.push_back(
          diagonal_covariance(plan.sigma_drift_m, plan.sigma_drift_rad, kCorridorDrift_m * along(from)));
    }
    sim.truth.back().T_map_world = map.T_map_world;
    sim.drive.poses.push_back(scan_pose(map.T_map_world * to, plan, along(to), rng));
  }
  sim.drive.start = sim.truth.front();
  sim.drive.start.bias = {};
  sim.drive.start.velocity_mps += normal_vector(rng, 0.5);
  const double tilt = smoother.sigma_start_tilt_rad;
  const Eigen::Vector3d lean(rng.normal(0, tilt), rng.normal(0, tilt),
                             rng.normal(0, smoother.sigma_start_yaw_rad));
  const SE3 T = sim.drive.start.T_world_body;
  sim.drive.start.T_world_body =
      SE3(T.translation() + normal_vector(rng, smoother.sigma_start_m), so3_exp(lean) * T.rotation());
  return sim;
}

}  // namespace radioslam::test
