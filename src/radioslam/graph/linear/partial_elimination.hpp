// Elimination of some blocks of a sparse symmetric positive definite system, which leaves a dense one on the
// others: H x = b with x = (e, k) becomes
//   (H_kk - H_ke H_ee^-1 H_ek) k = b_k - H_ke H_ee^-1 b_e,   then   e = H_ee^-1 (b_e - H_ek k).
// Cost: a factorisation of H_ee and a solve per kept scalar that touches it.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/graph/linear/block_cholesky.hpp"

namespace radioslam {

class PartialElimination {
 public:
  /// `kept`: blocks of the pattern, in the order that the dense system has them.
  PartialElimination(const BlockPattern& pattern, const std::vector<std::size_t>& kept);

  /// H_ee must be positive definite, H need not be.
  Factorization factorize(const SymmetricBlockMatrix& matrix);
  /// The dense system's matrix.
  const Eigen::MatrixXd& reduced() const { return reduced_; }
  /// Its right side, for one of the whole system.
  Eigen::VectorXd reduce(const Eigen::VectorXd& b) const;
  /// b_e^T H_ee^-1 b_e.
  double eliminated_norm(const Eigen::VectorXd& b) const;
  /// The solution of the whole system for one of the dense system.
  Eigen::VectorXd expand(const Eigen::VectorXd& b, const Eigen::VectorXd& kept) const;

 private:
  Eigen::VectorXd eliminated_part(const Eigen::VectorXd& x) const;
  Eigen::VectorXd kept_part(const Eigen::VectorXd& x) const;
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;

  std::vector<std::size_t> eliminated_scalars_, kept_scalars_;  ///< places in the whole system
  std::vector<std::int32_t> place_;         ///< per block: among the eliminated, or -1 - k
  std::vector<Eigen::Index> kept_offsets_;  ///< per kept block
  std::optional<SymmetricBlockMatrix> inner_;
  std::optional<BlockCholesky> cholesky_;
  Eigen::MatrixXd between_;  ///< H_ek
  Eigen::MatrixXd reduced_;
};

}  // namespace radioslam
