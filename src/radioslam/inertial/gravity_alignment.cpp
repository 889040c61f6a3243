#include "radioslam/inertial/gravity_alignment.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/geometry/so3.hpp"

namespace radioslam {
namespace {

using Poses = std::vector<StampedPose<SE3>>;
using Steps = std::vector<Preintegration>;

constexpr int kBiasRounds = 3;    // nearly linear: the error is quadratic in bias times time between poses
constexpr int kLengthRounds = 5;  // on the sphere of known magnitude
constexpr int kGravity = 0, kBias = 3, kVelocities = 6;  // offsets of the unknowns

Poses first_poses(const Trajectory<SE3>& odometry, double window_s) {
  Poses poses;
  for (const auto& row : odometry) {
    if (seconds_between(odometry.front().stamp, row.stamp) > window_s) break;
    poses.push_back(row);
  }
  return poses;
}

std::optional<Steps> preintegrate_steps(const Poses& poses, const std::vector<ImuSample>& samples,
                                        const InertialBias& bias, const ImuNoiseParams& noise) {
  Steps steps;
  for (std::size_t k = 0; k + 1 < poses.size(); ++k) {
    auto step = preintegrate(samples, poses[k].stamp, poses[k + 1].stamp, bias, noise);
    if (!step) return std::nullopt;
    steps.push_back(std::move(*step));
  }
  return steps;
}

/// Change of the gyroscope bias that best aligns its rotations with the odometry's.
Eigen::Vector3d bias_change(const Poses& poses, const Steps& steps) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d pull = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const Eigen::Quaterniond turned = poses[k].pose.rotation().conjugate() * poses[k + 1].pose.rotation();
    const Eigen::Vector3d missing = so3_log(steps[k].motion.rotation.conjugate() * turned);
    const Eigen::Matrix3d by_bias = steps[k].bias_jacobian.block<3, 3>(Preintegration::kRotation, 0);
    information += by_bias.transpose() * by_bias;
    pull += by_bias.transpose() * missing;
  }
  return ldlt_solve(information, pull);
}

/// H x = pull, x = [gravity, accelerometer bias, velocities].
struct LinearSystem {
  Eigen::MatrixXd information;
  Eigen::VectorXd pull;
};

/// One step's [position; velocity] residual, linear in [gravity, bias, velocity before, velocity after].
struct StepEquation {
  Eigen::Matrix<double, 6, 12> by_unknowns = Eigen::Matrix<double, 6, 12>::Zero();
  Eigen::Matrix<double, 6, 1> constant;
  Eigen::Matrix<double, 6, 6> information;
};

StepEquation step_equation(const SE3& from, const SE3& to, const Preintegration& step,
                           const ImuNoiseParams& noise, const GravityAlignmentParams& params) {
  constexpr int kAccelerometer = 3;  // column in the bias Jacobian
  constexpr int p = Preintegration::kPosition, v = Preintegration::kVelocity;
  const double t = step.motion.duration_s;
  const Eigen::Matrix3d back = from.rotation_matrix().transpose();
  StepEquation e;
  e.by_unknowns.block<3, 3>(0, 0) = -0.5 * t * t * back;
  e.by_unknowns.block<3, 3>(3, 0) = -t * back;
  e.by_unknowns.block<3, 3>(0, 3) = -step.bias_jacobian.block<3, 3>(p, kAccelerometer);
  e.by_unknowns.block<3, 3>(3, 3) = -step.bias_jacobian.block<3, 3>(v, kAccelerometer);
  e.by_unknowns.block<3, 3>(0, 6) = -t * back;
  e.by_unknowns.block<3, 3>(3, 6) = -back;
  e.by_unknowns.block<3, 3>(3, 9) = back;
  e.constant << back * (to.translation() - from.translation()) - step.motion.position_m,
      -step.motion.velocity_mps;
  Eigen::Matrix<double, 6, 6> covariance;
  covariance << step.covariance.block<3, 3>(p, p), step.covariance.block<3, 3>(p, v),
      step.covariance.block<3, 3>(v, p), step.covariance.block<3, 3>(v, v);
  const double sigma_v_mps = params.sigma_rotation_rad * noise.gravity_mps2 * t;  // tilted gravity
  covariance.diagonal().head<3>().array() += params.sigma_position_m * params.sigma_position_m;
  covariance.diagonal().tail<3>().array() += sigma_v_mps * sigma_v_mps;
  e.information = inverse(covariance);
  return e;
}

LinearSystem gravity_equations(const Poses& poses, const Steps& steps, const ImuNoiseParams& noise,
                               const GravityAlignmentParams& params) {
  const auto size = static_cast<Eigen::Index>(kVelocities + 3 * poses.size());
  LinearSystem sum{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size)};
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const StepEquation e = step_equation(poses[k].pose, poses[k + 1].pose, steps[k], noise, params);
    const Eigen::Matrix<double, 12, 12> h = e.by_unknowns.transpose() * e.information * e.by_unknowns;
    const Eigen::Matrix<double, 12, 1> b = -e.by_unknowns.transpose() * e.information * e.constant;
    const auto at = static_cast<Eigen::Index>(kVelocities + 3 * k);
    sum.information.topLeftCorner<6, 6>() += h.topLeftCorner<6, 6>();
    sum.information.block<6, 6>(0, at) += h.topRightCorner<6, 6>();
    sum.information.block<6, 6>(at, 0) += h.bottomLeftCorner<6, 6>();
    sum.information.block<6, 6>(at, at) += h.bottomRightCorner<6, 6>();
    sum.pull.head<6>() += b.head<6>();
    sum.pull.segment<6>(at) += b.tail<6>();
  }
  const double sigma = noise.sigma_accelerometer_bias_mps2;
  sum.information.diagonal().segment<3>(kBias).array() += 1 / (sigma * sigma);
  return sum;
}

/// Orthonormal basis of the plane perpendicular to `direction`.
Eigen::Matrix<double, 3, 2> plane_across(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d first = direction.unitOrthogonal();
  Eigen::Matrix<double, 3, 2> plane;
  plane << first, direction.cross(first);
  return plane;
}

struct KnownMagnitude {
  Eigen::VectorXd unknowns;
  double sigma_tilt_rad = 0;
};

/// The solution with gravity of this magnitude, from an initial guess of its direction.
KnownMagnitude solve_with_length(const LinearSystem& system, Eigen::Vector3d down, double length) {
  const Eigen::Index size = system.pull.size(), rest = size - kBias;
  KnownMagnitude solution;
  for (int round = 0; round < kLengthRounds; ++round) {
    Eigen::MatrixXd free = Eigen::MatrixXd::Zero(size, rest + 2);
    free.topLeftCorner<3, 2>() = length * plane_across(down);
    free.bottomRightCorner(rest, rest).setIdentity();
    Eigen::VectorXd start = Eigen::VectorXd::Zero(size);
    start.segment<3>(kGravity) = length * down;
    const Eigen::LDLT<Eigen::MatrixXd> factor(free.transpose() * system.information * free);
    const Eigen::VectorXd step = factor.solve(free.transpose() * (system.pull - system.information * start));
    down = (down + plane_across(down) * step.head<2>()).normalized();
    solution.unknowns = free * step + start;
    solution.unknowns.segment<3>(kGravity) = length * down;
    const Eigen::MatrixXd tilt = factor.solve(Eigen::MatrixXd::Identity(rest + 2, 2)).topRows<2>();
    const Eigen::Matrix2d covariance = 0.5 * (tilt + tilt.transpose());
    solution.sigma_tilt_rad = std::sqrt(symmetric_eigen(covariance).values.maxCoeff());
  }
  return solution;
}

std::vector<InertialState> turned_states(const Poses& poses, const Eigen::Quaterniond& R,
                                         const Eigen::VectorXd& unknowns, const Eigen::Vector3d& gyroscope) {
  const SE3 T_world_odometry(Eigen::Vector3d::Zero(), R);
  std::vector<InertialState> states;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const Eigen::Vector3d velocity = unknowns.segment<3>(static_cast<Eigen::Index>(kVelocities + 3 * k));
    states.push_back(
        {T_world_odometry * poses[k].pose, R * velocity, {gyroscope, unknowns.segment<3>(kBias)}});
  }
  return states;
}

}  // namespace

std::optional<GravityAlignment> align_gravity(const Trajectory<SE3>& odometry,
                                              const std::vector<ImuSample>& samples,
                                              const ImuNoiseParams& noise,
                                              const GravityAlignmentParams& params) {
  const Poses poses = first_poses(odometry, params.window_s);
  if (poses.size() < static_cast<std::size_t>(std::max(params.min_poses, 3))) return std::nullopt;
  InertialBias bias;
  auto steps = preintegrate_steps(poses, samples, bias, noise);
  for (int round = 0; steps && round < kBiasRounds; ++round) {
    bias.gyroscope_radps += bias_change(poses, *steps);
    steps = preintegrate_steps(poses, samples, bias, noise);
  }
  if (!steps) return std::nullopt;
  const LinearSystem system = gravity_equations(poses, *steps, noise, params);
  const Eigen::Vector3d gravity = ldlt_solve(system.information, system.pull).segment<3>(kGravity);
  const double length = gravity.norm();
  if (!(std::abs(length - noise.gravity_mps2) <= params.max_gravity_error_mps2)) return std::nullopt;
  const KnownMagnitude solution = solve_with_length(system, gravity / length, noise.gravity_mps2);
  const Eigen::Vector3d up = -solution.unknowns.segment<3>(kGravity);
  GravityAlignment result;
  result.R_world_odometry = rotation_between(up, Eigen::Vector3d::UnitZ());
  result.sigma_tilt_rad = solution.sigma_tilt_rad;
  result.measured_gravity_mps2 = length;
  result.states = turned_states(poses, result.R_world_odometry, solution.unknowns, bias.gyroscope_radps);
  return result;
}

}  // namespace radioslam
