#include "radioslam/inertial/odometry_noise_of_states.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>

namespace radioslam {
namespace {

using Noise = std::vector<SE3::Jacobian>;  ///< of each step

/// Ad(T_b_k), which takes errors at state k to state b.
SE3::Jacobian carry(const InertialTrajectory& trajectory, std::size_t b, std::size_t k) {
  const SE3& T_world_b = trajectory.states[b].T_world_body;
  return (T_world_b.inverse() * trajectory.states[k].T_world_body).adjoint();
}

/// Where a covariance exceeds what its parts add up to.
struct MissingNoise {
  SE3::Jacobian directions = SE3::Jacobian::Zero();  ///< e_m, by the root of what is missing along it
  SE3::Jacobian shares = SE3::Jacobian::Zero();      ///< rows u_m^T L^-1
};

MissingNoise missing_noise(const SE3::Jacobian& sum, const SE3::Jacobian& wanted) {
  MissingNoise missing;
  const Eigen::LLT<SE3::Jacobian> factor(sum);
  if (factor.info() != Eigen::Success) return missing;
  const SE3::Jacobian L = factor.matrixL(), inverse = factor.matrixL().solve(SE3::Jacobian::Identity());
  const SE3::Jacobian ratio = inverse * wanted * inverse.transpose();
  const Eigen::SelfAdjointEigenSolver<SE3::Jacobian> eigen(0.5 * (ratio + ratio.transpose()));
  const SE3::Jacobian& U = eigen.eigenvectors();
  const SE3::Tangent excess = (eigen.eigenvalues().array() - 1).max(0).sqrt();
  return {L * U * excess.asDiagonal(), U.transpose() * inverse};
}

/// Makes the steps from state `a` to state `b` add up to at least T_a_b's covariance.
void enlarge_span(Noise& noise, const InertialTrajectory& trajectory, std::size_t a, std::size_t b) {
  SE3::Jacobian sum = SE3::Jacobian::Zero();
  for (std::size_t k = a; k < b; ++k) {
    const SE3::Jacobian A = carry(trajectory, b, k + 1);
    sum += A * noise[k] * A.transpose();
  }
  const MissingNoise missing = missing_noise(sum, trajectory.relative_pose(a, b).covariance);
  if (missing.directions.isZero(0)) return;
  for (std::size_t k = a; k < b; ++k) {
    const SE3::Jacobian to_shares = missing.shares * carry(trajectory, b, k + 1);
    const SE3::Tangent share = (to_shares * noise[k] * to_shares.transpose()).diagonal();
    const SE3::Jacobian added = carry(trajectory, k + 1, b) * missing.directions;
    noise[k] += added * share.asDiagonal() * added.transpose();
  }
}

}  // namespace

std::vector<OdometryStepNoise> odometry_noise_of_states(const InertialTrajectory& trajectory,
                                                        const OdometryNoiseOfStatesParams& params) {
  const auto& stamps = trajectory.stamps;
  const std::size_t steps = stamps.size() - 1;
  Noise noise;
  for (std::size_t k = 0; k < steps; ++k) noise.push_back(trajectory.relative_pose(k, k + 1).covariance);
  for (std::size_t span = 2; span < 2 * steps; span *= 2)
    for (std::size_t a = 0; a < steps; a += span) {
      const std::size_t b = std::min(a + span, steps);
      if (seconds_between(stamps[a], stamps[b]) <= params.longest_span_s)
        enlarge_span(noise, trajectory, a, b);
    }
  std::vector<OdometryStepNoise> result;
  for (std::size_t k = 0; k < steps; ++k)
    result.push_back({stamps[k], stamps[k + 1], noise[k] / seconds_between(stamps[k], stamps[k + 1])});
  return result;
}

}  // namespace radioslam
