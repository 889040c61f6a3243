// One suite of laws over every pose type.
#include <gtest/gtest.h>

#include <numbers>

#include "radioslam/base/random.hpp"
#include "radioslam/geometry/se2.hpp"
#include "radioslam/geometry/se3.hpp"

namespace radioslam {
namespace {

template <class Pose>
class PoseLaws : public testing::Test {
 protected:
  using Tangent = typename Pose::Tangent;
  using Jacobian = typename Pose::Jacobian;

  Rng rng{42};

  /// Rotations up to `angle`, translations up to `metres` per axis.
  Tangent tangent(double metres, double angle) {
    Tangent xi;
    for (int i = 0; i < Pose::kDim; ++i) xi[i] = rng.uniform(-metres, metres);
    Eigen::Matrix<double, Pose::kDof - Pose::kDim, 1> w;
    for (Eigen::Index i = 0; i < w.size(); ++i) w[i] = rng.normal();
    xi.template tail<Pose::kDof - Pose::kDim>() = w.normalized() * rng.uniform(0, angle);
    return xi;
  }
  Pose pose() { return Pose::exp(tangent(10, 3.1)); }
  static Jacobian numerical(const auto& f) {
    constexpr double h = 1e-6;
    Jacobian j;
    for (int k = 0; k < Pose::kDof; ++k) {
      const Tangent step = h * Tangent::Unit(k);
      j.col(k) = (f(step) - f(-step)) / (2 * h);
    }
    return j;
  }
  static double distance(const Pose& a, const Pose& b) { return (a.inverse() * b).log().norm(); }
};

using Poses = testing::Types<SE2, SE3>;
TYPED_TEST_SUITE(PoseLaws, Poses);

TYPED_TEST(PoseLaws, LogInvertsExpFromTinyToNearlyPi) {
  for (const double angle : {1e-9, 1e-5, 9e-4, 1.1e-3, 0.01, 0.3, 2.0, std::numbers::pi - 1e-4})
    for (int n = 0; n < 200; ++n) {
      const auto xi = this->tangent(5, angle);
      EXPECT_LT((TypeParam::exp(xi).log() - xi).norm(), 1e-9) << xi.transpose();
    }
}

TYPED_TEST(PoseLaws, GroupAxioms) {
  for (int n = 0; n < 200; ++n) {
    const TypeParam a = this->pose(), b = this->pose(), c = this->pose();
    EXPECT_LT(this->distance((a * b) * c, a * (b * c)), 1e-12);
    EXPECT_LT(this->distance(a * a.inverse(), TypeParam()), 1e-12);
    EXPECT_LT(this->distance((a * b).inverse(), b.inverse() * a.inverse()), 1e-12);
    const typename TypeParam::Point p = TypeParam::Point::Random();
    EXPECT_LT(((a * b) * p - a * (b * p)).norm(), 1e-12);
  }
}

TYPED_TEST(PoseLaws, AdjointMovesAPerturbationToTheLeft) {
  for (int n = 0; n < 200; ++n) {
    const TypeParam a = this->pose();
    const auto xi = this->tangent(1, 1);
    EXPECT_LT(this->distance(a * TypeParam::exp(xi), TypeParam::exp(a.adjoint() * xi) * a), 1e-10);
  }
}

TYPED_TEST(PoseLaws, RightJacobiansEqualNumericalOnes) {
  for (const double angle : {1e-6, 5e-3, 0.02, 0.5, 2.5})
    for (int n = 0; n < 50; ++n) {
      const auto xi = this->tangent(3, angle);
      const auto inverse =
          this->numerical([&](const auto& d) { return (TypeParam::exp(xi) * TypeParam::exp(d)).log(); });
      EXPECT_LT((TypeParam::right_jacobian_inverse(xi) - inverse).norm(), 1e-7) << xi.transpose();
      const auto forward = this->numerical(
          [&](const auto& d) { return (TypeParam::exp(xi).inverse() * TypeParam::exp(xi + d)).log(); });
      EXPECT_LT((TypeParam::right_jacobian(xi) - forward).norm(), 1e-7) << xi.transpose();
    }
}

TYPED_TEST(PoseLaws, ComposingPosesKeepsThemPoses) {
  TypeParam a = this->pose();
  for (int n = 0; n < 10000; ++n) a = a * TypeParam::exp(this->tangent(0.1, 0.1));
  EXPECT_NEAR(a.rotation_matrix().determinant(), 1, 1e-12);
}

TEST(SE3, FlattenedLiftIsTheSamePose) {
  const SE2 pose({3, -2}, 2.5);
  const SE2 back = flatten(lift(pose, 7));
  EXPECT_NEAR((pose.inverse() * back).log().norm(), 0, 1e-12);
}

TEST(WrapAngle, KeepsTheOpenLowerEnd) {
  using std::numbers::pi;
  EXPECT_DOUBLE_EQ(wrap_angle(pi), pi);
  EXPECT_DOUBLE_EQ(wrap_angle(-pi), pi);
  EXPECT_NEAR(wrap_angle(7), 7 - 2 * pi, 1e-15);
  EXPECT_NEAR(wrap_angle(-1e4), std::remainder(-1e4, 2 * pi), 1e-9);
}

}  // namespace
}  // namespace radioslam
