// Block tridiagonal normal equations of a chain of states: Cholesky solution, and covariances of all states.
//
//   H = L L^T, L_k = chol(H_k - C_k C_k^T), C_(k+1) = B_k L_k^-T            B_k: row k + 1, column k of H
//   x_k given x_(k+1):  S_k,m = G_k S_(k+1),m for m > k,  G_k = -L_k^-T C_(k+1)^T
//   S_k,k = (L_k L_k^T)^-1 + G_k S_(k+1),(k+1) G_k^T
// Cost: some 21 x 21 products per state; a cross-covariance takes one per state in between.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/inertial/inertial_state.hpp"

namespace radioslam {

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

}  // namespace radioslam
