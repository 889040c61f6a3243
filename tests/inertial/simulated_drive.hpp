// A robot with a laser scanner's odometry and an inertial unit, both with the errors that they state.
#pragma once

#include <utility>
#include <vector>

#include "inertial/smooth_motion.hpp"
#include "radioslam/geometry/so3.hpp"
#include "radioslam/inertial/inertial_smoother.hpp"

namespace radioslam::test {

/// How long the drive is, and how well the scans tell the motion.
struct DrivePlan {
  double duration_s = 4;
  double states_hz = 10, readings_hz = 200;
  double sigma_position_m = 0.02, sigma_rotation_rad = 0.003;  ///< of one step by scans
  double corridor_begin_s = 0, corridor_end_s = 0;  ///< there scans see no motion along the world's x
  Liveliness liveliness{1, 0.3, 2, 0.5, 0.1};
  Eigen::Vector3d course_mps = Eigen::Vector3d::Zero();
};

struct SimulatedDrive {
  InertialDrive drive;
  std::vector<InertialSample> samples;
  std::vector<InertialState> truth;  ///< at the drive's stamps
};

constexpr double kCorridorSigma_m = 100;

/// What scans tell of T_i_j: with noise, or in the corridor nothing of its way along `along` in frame j.
inline PoseStep scan_step(const SE3& T_i_j, const DrivePlan& plan, const Eigen::Vector3d& along, Rng& rng) {
  SE3::Jacobian covariance = SE3::Jacobian::Zero();
  covariance.diagonal().head<3>().setConstant(plan.sigma_position_m * plan.sigma_position_m);
  covariance.diagonal().tail<3>().setConstant(plan.sigma_rotation_rad * plan.sigma_rotation_rad);
  covariance.topLeftCorner<3, 3>() += kCorridorSigma_m * kCorridorSigma_m * along * along.transpose();
  SE3::Tangent noise;
  noise << normal_vector(rng, plan.sigma_position_m), normal_vector(rng, plan.sigma_rotation_rad);
  const Eigen::Vector3d way = T_i_j.rotation().conjugate() * T_i_j.translation();
  noise.head<3>() -= along * along.dot(way + noise.head<3>());
  return {T_i_j * SE3::exp(noise), covariance.inverse()};
}

/// The start's guess is drawn about the truth with the sigmas that the smoother assumes.
inline SimulatedDrive simulate_drive(const DrivePlan& plan, const InertialNoiseParams& noise,
                                     const InertialSmootherParams& smoother, Rng rng) {
  SmoothMotion motion(rng.split("motion"), plan.liveliness);
  motion.add_course(plan.course_mps);
  SimulatedDrive sim;
  sim.samples = perfect_readings(motion, plan.duration_s + 0.1, plan.readings_hz, noise);
  const InertialBias bias{normal_vector(rng, noise.sigma_gyroscope_bias_radps),
                          normal_vector(rng, noise.sigma_accelerometer_bias_mps2)};
  const auto biases = add_errors(sim.samples, bias, plan.readings_hz, noise, rng);
  for (int k = 0; k <= std::lround(plan.duration_s * plan.states_hz); ++k) {
    const double t = k / plan.states_hz;
    sim.drive.stamps.push_back(Stamp::from_seconds(t));
    sim.truth.push_back(motion.state(t));
    sim.truth.back().bias = biases[static_cast<std::size_t>(std::lround(t * plan.readings_hz))];
    if (k == 0) continue;
    const bool in_corridor = plan.corridor_begin_s < t && t <= plan.corridor_end_s;
    const SE3 &from = sim.truth[sim.truth.size() - 2].T_world_body, &to = sim.truth.back().T_world_body;
    const Eigen::Vector3d along = in_corridor
                                      ? Eigen::Vector3d(to.rotation().conjugate() * Eigen::Vector3d::UnitX())
                                      : Eigen::Vector3d(Eigen::Vector3d::Zero());
    sim.drive.steps.push_back(scan_step(from.inverse() * to, plan, along, rng));
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
