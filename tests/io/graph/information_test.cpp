#include "radioslam/io/graph/information.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cstdlib>

namespace radioslam {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// A symmetric matrix with the given eigenvalues in a random basis.
Matrix6 with_eigenvalues(const Eigen::Matrix<double, 6, 1>& values) {
  std::srand(3);
  const Matrix6 random = Matrix6::Random();
  const Matrix6 basis = Eigen::SelfAdjointEigenSolver<Matrix6>(random + random.transpose()).eigenvectors();
  return basis * values.asDiagonal() * basis.transpose();
}

TEST(Information, AcceptsPositiveSemidefiniteMatricesUpToRounding) {
  EXPECT_TRUE(is_information(with_eigenvalues({1, 2, 3, 4, 5, 6})));
  EXPECT_TRUE(is_information(with_eigenvalues({0, 0, 3, 4, 5, 6})));
  EXPECT_TRUE(is_information(with_eigenvalues({-1e-7, 2, 3, 4, 5, 6})));
  EXPECT_TRUE(is_information(Matrix6(1e300 * with_eigenvalues({1, 2, 3, 4, 5, 6}))));
  EXPECT_TRUE(is_information(Eigen::Matrix3d(Eigen::Matrix3d::Zero())));
}

TEST(Information, RefusesIndefiniteMatrices) {
  EXPECT_FALSE(is_information(with_eigenvalues({-1e-3, 2, 3, 4, 5, 6})));
  EXPECT_FALSE(is_information(Eigen::Matrix3d(-Eigen::Matrix3d::Identity())));
  EXPECT_NEAR(relative_smallest_eigenvalue(with_eigenvalues({-3, 2, 3, 4, 5, 6})), -0.5, 1e-12);
}

TEST(Information, ClipsOnlyTheNegativeEigenvalues) {
  const Matrix6 nearest = nearest_information(with_eigenvalues({-3, 2, 3, 4, 5, 6}));
  EXPECT_TRUE(is_information(nearest));
  EXPECT_LT((nearest - with_eigenvalues({0, 2, 3, 4, 5, 6})).norm(), 1e-7);
  EXPECT_EQ(nearest, nearest.transpose());
}

}  // namespace
}  // namespace radioslam
