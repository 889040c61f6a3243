// Decompositions and products of dense matrices, compiled once: Eigen's templates behind them cost a source
// that instantiates them up to two seconds each. Every function computes what the Eigen expression in its
// comment computes, bit for bit; arguments are plain matrices of the types instantiated in the .cpp files:
// 2x2, 3x3, 4x4, 6x6, 9x9, dynamic and, where they occur, complex ones.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <type_traits>

namespace radioslam {

/// A column of the matrix.
template <class Matrix>
using ColumnOf =
    Eigen::Matrix<typename Matrix::Scalar, Matrix::RowsAtCompileTime, 1, 0, Matrix::MaxRowsAtCompileTime, 1>;
template <class Matrix>
using RealColumnOf = Eigen::Matrix<typename Matrix::RealScalar, Matrix::RowsAtCompileTime, 1, 0,
                                   Matrix::MaxRowsAtCompileTime, 1>;

/// Eigenvalues of a symmetric (Hermitian) matrix, ascending, and by column their unit eigenvectors.
template <class Matrix>
struct SymmetricEigen {
  RealColumnOf<Matrix> values;
  Matrix vectors;
};
/// Eigen::SelfAdjointEigenSolver<Matrix>(a).
template <class Matrix>
SymmetricEigen<Matrix> symmetric_eigen(const Matrix& a);
/// Eigen::SelfAdjointEigenSolver<Matrix>(a, Eigen::EigenvaluesOnly).eigenvalues().
template <class Matrix>
RealColumnOf<Matrix> symmetric_eigenvalues(const Matrix& a);

/// Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>().computeDirect(a).
SymmetricEigen<Eigen::Matrix2d> symmetric_eigen_direct(const Eigen::Matrix2d& a);

/// a.inverse().
template <class Matrix>
Matrix inverse(const Matrix& a);

/// Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(a).pseudoInverse().
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& a);

/// a.ldlt().solve(b) of a column and of a matrix of the same size as `a`.
template <class Matrix>
ColumnOf<Matrix> ldlt_solve(const Matrix& a, const std::type_identity_t<ColumnOf<Matrix>>& b);
template <class Matrix>
Matrix ldlt_solve_matrix(const Matrix& a, const std::type_identity_t<Matrix>& b);

/// Eigen::LLT<Matrix>, a = L Lᵀ with L lower triangular.
template <class Matrix>
class Cholesky {
 public:
  explicit Cholesky(const Matrix& a);

  /// Whether `a` is positive definite.
  bool succeeded() const { return succeeded_; }
  /// L in the lower triangle; above it, `a`.
  const Matrix& factor() const { return factor_; }
  Matrix lower() const;
  /// a⁻¹ b.
  ColumnOf<Matrix> solve(const ColumnOf<Matrix>& b) const;
  Matrix solve_matrix(const Matrix& b) const;
  Matrix inverse() const;
  /// c - b a⁻¹ bᵀ: the information that remains when the variables of `a` are eliminated.
  Matrix schur_complement(const Matrix& c, const Matrix& b) const;
  /// L⁻¹ b: whitens an error of covariance `a`.
  ColumnOf<Matrix> whitened(const ColumnOf<Matrix>& b) const;
  Matrix whitened_matrix(const Matrix& b) const;

 private:
  Matrix factor_;
  bool succeeded_;
};

/// The inverse by Cholesky decomposition; nothing if `a` is not positive definite or its reciprocal condition
/// number is at most `min_condition`.
template <class Matrix>
std::optional<Matrix> inverse_if_regular(const Matrix& a, double min_condition);

/// j p jᵀ: the covariance p carried by the Jacobian j.
template <class Jacobian, class Matrix>
Eigen::Matrix<double, Jacobian::RowsAtCompileTime, Jacobian::RowsAtCompileTime> congruence(const Jacobian& j,
                                                                                           const Matrix& p);
/// j p jᵀ + q: carried, with q added. Rounds as that one expression does, and as `q += j * p * j.transpose()`
/// does, which is not the sum of congruence(j, p) and q.
template <class Jacobian, class Matrix>
Eigen::Matrix<double, Jacobian::RowsAtCompileTime, Jacobian::RowsAtCompileTime> congruence(
    const Jacobian& j, const Matrix& p,
    const Eigen::Matrix<double, Jacobian::RowsAtCompileTime, Jacobian::RowsAtCompileTime>& q);
/// jᵀ w j: the information w about what j maps.
template <class Jacobian, class Matrix>
Eigen::Matrix<double, Jacobian::ColsAtCompileTime, Jacobian::ColsAtCompileTime> normal_matrix(
    const Jacobian& j, const Matrix& w);

}  // namespace radioslam
