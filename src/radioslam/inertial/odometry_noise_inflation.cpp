#include "radioslam/inertial/odometry_noise_inflation.hpp"

#include <algorithm>

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

using Noise = std::vector<SE3::Jacobian>;  ///< of each step

/// Ad(T_b_k), which transforms errors from state k to state b.
SE3::Jacobian carry(const InertialTrajectory& trajectory, std::size_t b, std::size_t k) {
  const SE3& T_world_b = trajectory.states[b].T_world_body;
  return (T_world_b.inverse() * trajectory.states[k].T_world_body).adjoint();
}

/// Deficit of the summed noise against a covariance.
struct NoiseDeficit {
  SE3::Jacobian directions = SE3::Jacobian::Zero();  ///< columns e_m sqrt(max(0, l_m - 1))
  SE3::Jacobian weights = SE3::Jacobian::Zero();     ///< rows u_m^T L^-1
};

NoiseDeficit noise_deficit(const SE3::Jacobian& sum, const SE3::Jacobian& wanted) {
  NoiseDeficit missing;
  const Cholesky<SE3::Jacobian> factor(sum);
  if (!factor.succeeded()) return missing;
  const SE3::Jacobian L = factor.lower(), inverse = factor.whitened_matrix(SE3::Jacobian::Identity());
  const SE3::Jacobian ratio = congruence(inverse, wanted);
  const auto eigen = symmetric_eigen<SE3::Jacobian>(0.5 * (ratio + ratio.transpose()));
  const SE3::Jacobian& U = eigen.vectors;
  const SE3::Tangent excess = (eigen.values.array() - 1).max(0).sqrt();
  return {L * U * excess.asDiagonal(), U.transpose() * inverse};
}

/// Inflates the steps from state `a` to state `b` to add up to at least the covariance of T_a_b.
void inflate_span(Noise& noise, const InertialTrajectory& trajectory, std::size_t a, std::size_t b) {
  SE3::Jacobian sum = SE3::Jacobian::Zero();
  for (std::size_t k = a; k < b; ++k) {
    const SE3::Jacobian A = carry(trajectory, b, k + 1);
    sum = congruence(A, noise[k], sum);
  }
  const NoiseDeficit missing = noise_deficit(sum, trajectory.relative_pose(a, b).covariance);
  if (missing.directions.isZero(0)) return;
  for (std::size_t k = a; k < b; ++k) {
    const SE3::Jacobian to_weights = missing.weights * carry(trajectory, b, k + 1);
    const SE3::Tangent weight = (to_weights * noise[k] * to_weights.transpose()).diagonal();
    const SE3::Jacobian added = carry(trajectory, k + 1, b) * missing.directions;
    noise[k] += added * weight.asDiagonal() * added.transpose();
  }
}

}  // namespace

std::vector<OdometryStepNoise> odometry_noise_inflation(const InertialTrajectory& trajectory,
                                                        const OdometryNoiseInflationParams& params) {
  const auto& stamps = trajectory.stamps;
  const std::size_t steps = stamps.size() - 1;
  Noise noise;
  for (std::size_t k = 0; k < steps; ++k) noise.push_back(trajectory.relative_pose(k, k + 1).covariance);
  for (std::size_t span = 2; span < 2 * steps; span *= 2)
    for (std::size_t a = 0; a < steps; a += span) {
      const std::size_t b = std::min(a + span, steps);
      if (seconds_between(stamps[a], stamps[b]) <= params.max_span_s) inflate_span(noise, trajectory, a, b);
    }
  std::vector<OdometryStepNoise> result;
  for (std::size_t k = 0; k < steps; ++k)
    result.push_back({stamps[k], stamps[k + 1], noise[k] / seconds_between(stamps[k], stamps[k + 1])});
  return result;
}

}  // namespace radioslam
