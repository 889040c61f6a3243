// Batch smoother of one robot's states from poses on a map (measured by scan matching, say) and IMU samples.
//
// Least squares of state_factors.hpp over the whole drive by damped Gauss-Newton on the chain
// (below), initialised by the filter (inertial_filter.hpp); afterwards the IMU is preintegrated
// again with the estimated biases and the minimisation repeated. Motion that the poses do not constrain -
// along a featureless corridor, or roll and pitch after a long distance - follows the IMU.
//
// Position and heading are relative to the start; roll, pitch, velocity and biases at the start have priors
// with the given sigmas. The map's frame is the world's at the start, but for its tilt, and drifts as stated.
// Refuses a drive with a step without IMU samples onto a map pose of less than full rank.
// Cost: linear in states and IMU samples, some 60 us per state and step.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/inertial/preintegration.hpp"
#include "radioslam/inertial/state_factors.hpp"

namespace radioslam {

// Block tridiagonal normal equations of a chain of states: Cholesky solution, and covariances of all states.
//
//   H = L L^T, L_k = chol(H_k - C_k C_k^T), C_(k+1) = B_k L_k^-T            B_k: row k + 1, column k of H
//   x_k given x_(k+1):  S_k,m = G_k S_(k+1),m for m > k,  G_k = -L_k^-T C_(k+1)^T
//   S_k,k = (L_k L_k^T)^-1 + G_k S_(k+1),(k+1) G_k^T
// Cost: some 21 x 21 products per state; a cross-covariance takes one per state in between.

/// Symmetric H, stored as diagonal and lower blocks.
struct ChainMatrix {
  std::vector<InertialState::Jacobian> diagonal;
  std::vector<InertialState::Jacobian> below;  ///< [k]: row k + 1, column k; one block fewer
};

/// The covariances of a chain's states.
class ChainCovariance {
 public:
  ChainCovariance(std::vector<InertialState::Jacobian> of_states,
                  std::vector<InertialState::Jacobian> by_next)
      : of_states_(std::move(of_states)), by_next_(std::move(by_next)) {}

  std::size_t size() const { return of_states_.size(); }
  const InertialState::Jacobian& of(std::size_t k) const { return of_states_[k]; }
  /// G_k: regression of state k's deviation on that of state k + 1.
  const InertialState::Jacobian& by_next(std::size_t k) const { return by_next_[k]; }
  /// Cross-covariance of state i with state j, i <= j.
  InertialState::Jacobian between(std::size_t i, std::size_t j) const;

 private:
  std::vector<InertialState::Jacobian> of_states_, by_next_;
};

class ChainFactor {
 public:
  /// Factor of H + damping * diag(H); nothing if that is not positive definite.
  static std::optional<ChainFactor> compute(const ChainMatrix& matrix, double damping);

  /// H^-1 b.
  std::vector<InertialState::Tangent> solve(std::vector<InertialState::Tangent> b) const;
  ChainCovariance covariance() const;

 private:
  std::vector<InertialState::Jacobian> lower_, coupling_;  ///< L_k, C_(k+1)
};

struct InertialSmootherParams {
  double sigma_start_m = 1e-3;
  double sigma_start_yaw_rad = 1e-3;
  double sigma_start_tilt_rad = 0.1;
  double sigma_start_velocity_mps = 10;
  double sigma_start_map_m = 10;
  double sigma_start_map_rad = 1;
  int max_iterations = 30;
  double cost_tolerance = 1e-4;
  double first_damping = 1e-6;
  double damping_factor = 10;
  double max_damping = 1e3;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(sigma_start_m, "m", 1e-6, 100,
                    "prior standard deviation of the first position, the frame's origin");
    RADIOSLAM_FIELD(sigma_start_yaw_rad, "rad", 1e-7, 3, "prior standard deviation of the first heading");
    RADIOSLAM_FIELD(
        sigma_start_tilt_rad, "rad", 1e-4, 3,
        "prior standard deviation of the first roll and pitch; weak, because the IMU observes them");
    RADIOSLAM_FIELD(sigma_start_velocity_mps, "m/s", 1e-3, 1000,
                    "prior standard deviation of the first velocity");
    RADIOSLAM_FIELD(
        sigma_start_map_m, "m", 1e-3, 1e6,
        "prior standard deviation of the map's initial position, where the first scan does not observe it");
    RADIOSLAM_FIELD(sigma_start_map_rad, "rad", 1e-3, 100,
                    "prior standard deviation of the map's initial orientation, where the first scan does "
                    "not observe it");
    RADIOSLAM_FIELD(max_iterations, "", 1, 1000, "largest number of iterations of the smoother");
    RADIOSLAM_FIELD(cost_tolerance, "", 1e-12, 1,
                    "predicted cost decrease below which the smoother has converged");
    RADIOSLAM_FIELD(first_damping, "", 1e-12, 1,
                    "damping after the first failed step, as a factor on diag(H)");
    RADIOSLAM_FIELD(damping_factor, "", 1.1, 1000,
                    "factor on the damping after a failed step, and its divisor after a successful one");
    RADIOSLAM_FIELD(max_damping, "", 1e-3, 1e10, "damping beyond which the smoother gives up");
  }
};

/// Measurements of a drive other than IMU samples.
struct InertialDrive {
  std::vector<Stamp> stamps;              ///< of the states, increasing, at least one
  std::vector<MapPose> poses;             ///< one per state
  std::vector<SE3::Jacobian> map_drifts;  ///< covariances from each state to the next, of Exp(xi) in the
                                          ///< former body frame: [translation, rotation], m^2, rad^2
  InertialState start;                    ///< initial guess at the first stamp, gravity-aligned, with biases
};

/// The smoothed states of a drive.
struct InertialTrajectory {
  std::vector<Stamp> stamps;
  std::vector<InertialState> states;
  ChainCovariance covariance;
  double cost = 0;  ///< sum of the factors' squared norms
  int iterations = 0;
  bool converged = false;

  /// T_i_j, i <= j, with its covariance from the joint one of both states. Cost: linear in the states
  /// between.
  UncertainPose<SE3> relative_pose(std::size_t i, std::size_t j) const;
};

/// Prior at the start: biases as in `noise` about those of `start`; T_map_world from `pose`.
StatePrior start_prior(const InertialState& start, const MapPose& pose, const ImuNoiseParams& noise,
                       const InertialSmootherParams& params);

/// The IMU samples may have gaps. Nothing if the smoother refuses.
std::optional<InertialTrajectory> smooth_inertially(const InertialDrive& drive,
                                                    const std::vector<ImuSample>& samples,
                                                    const ImuNoiseParams& noise,
                                                    const InertialSmootherParams& params);

}  // namespace radioslam
