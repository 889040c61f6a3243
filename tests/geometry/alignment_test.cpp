#include "radioslam/geometry/alignment.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

TEST(AlignPoints, RecoversAMotionOfThePlane) {
  std::srand(1);
  const Eigen::Matrix2Xd source = Eigen::Matrix2Xd::Random(2, 20);
  const SE2 truth({3, -4}, 2.8);
  Eigen::Matrix2Xd target = source;
  for (Eigen::Index i = 0; i < source.cols(); ++i) target.col(i) = truth * source.col(i);
  EXPECT_LT((align_points(source, target).inverse() * truth).log().norm(), 1e-12);
}

TEST(AlignPoints, RecoversAMotionOfSpace) {
  std::srand(2);
  const Eigen::Matrix3Xd source = Eigen::Matrix3Xd::Random(3, 20);
  const SE3 truth = SE3::exp((SE3::Tangent() << 1, 2, 3, 1, -2, 0.5).finished());
  Eigen::Matrix3Xd target = source;
  for (Eigen::Index i = 0; i < source.cols(); ++i) target.col(i) = truth * Eigen::Vector3d(source.col(i));
  EXPECT_LT((align_points(source, target).inverse() * truth).log().norm(), 1e-12);
}

TEST(AlignPoints, NeverReflects) {
  Eigen::Matrix3Xd source = Eigen::Matrix3Xd::Random(3, 10);
  Eigen::Matrix3Xd target = source;
  target.row(2) *= -1;
  EXPECT_NEAR(align_points(source, target).rotation_matrix().determinant(), 1, 1e-12);
}

TEST(AlignPoints, WeightsDecideBetweenContradictions) {
  Eigen::Matrix2Xd source(2, 3), target(2, 3);
  source << 0, 1, 5, 0, 0, 5;
  target << 2, 3, -9, 0, 0, -9;
  Eigen::VectorXd weights(3);
  weights << 1, 1, 0;
  const SE2 T = align_points(source, target, weights);
  EXPECT_LT((T.translation() - Eigen::Vector2d(2, 0)).norm(), 1e-12);
  EXPECT_NEAR(T.angle(), 0, 1e-12);
}

}  // namespace
}  // namespace radioslam
