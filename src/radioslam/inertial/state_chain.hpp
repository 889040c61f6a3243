// Normal equations of states of which each is tied to the next one only: block tridiagonal, solved by
// Cholesky from the first state to the last, and the covariances of all states from the same factor.
//
//   H = L L^T, L_k = chol(H_k - C_k C_k^T), C_(k+1) = B_k L_k^-T            B_k: row k + 1, column k of H
//   x_k depends on x_(k+1) alone:  S_k,m = G_k S_(k+1),m for m > k,  G_k = -L_k^-T C_(k+1)^T
//   S_k,k = (L_k L_k^T)^-1 + G_k S_(k+1),(k+1) G_k^T
// Cost: some 21 x 21 products per state; a covariance between states a and b: products of the states between.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/inertial/inertial_state.hpp"

namespace radioslam {

/// H, of which the half above the diagonal is understood.
struct ChainMatrix {
  std::vector<InertialState::Jacobian> diagonal;
  std::vector<InertialState::Jacobian> below;  ///< [k]: row k + 1, column k; one fewer
};

/// The covariances of a chain's states.
class ChainCovariance {
 public:
  ChainCovariance(std::vector<InertialState::Jacobian> of_states,
                  std::vector<InertialState::Jacobian> by_next)
      : of_states_(std::move(of_states)), by_next_(std::move(by_next)) {}

  std::size_t size() const { return of_states_.size(); }
  const InertialState::Jacobian& of(std::size_t k) const { return of_states_[k]; }
  /// G_k: what is to be expected of state k by a deviation of state k + 1.
  const InertialState::Jacobian& by_next(std::size_t k) const { return by_next_[k]; }
  /// Of state i with state j, i <= j.
  InertialState::Jacobian between(std::size_t i, std::size_t j) const;

 private:
  std::vector<InertialState::Jacobian> of_states_, by_next_;
};

class ChainFactor {
 public:
  /// Of H + damping * diag(H); nothing where it is not positive definite.
  static std::optional<ChainFactor> compute(const ChainMatrix& matrix, double damping);

  /// H^-1 b.
  std::vector<InertialState::Tangent> solve(std::vector<InertialState::Tangent> b) const;
  ChainCovariance covariance() const;

 private:
  std::vector<InertialState::Jacobian> lower_, coupling_;  ///< L_k, C_(k+1)
};

}  // namespace radioslam
