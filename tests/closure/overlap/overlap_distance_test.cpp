#include "radioslam/closure/overlap/overlap_distance.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <numbers>

#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

template <int Dim>
using Vec = Eigen::Matrix<double, Dim, 1>;
template <int Dim>
using Mat = Eigen::Matrix<double, Dim, Dim>;

template <int Dim>
Vec<Dim> normals(Rng& rng, double sigma) {
  Vec<Dim> v;
  for (int i = 0; i < Dim; ++i) v[i] = rng.normal(0, sigma);
  return v;
}

/// Random covariance with axes of very different lengths and random orientation.
template <int Dim>
Mat<Dim> long_and_thin(Rng& rng) {
  Mat<Dim> a;
  for (int i = 0; i < Dim; ++i) a.col(i) = normals<Dim>(rng, std::exp(rng.uniform(-2, 3)));
  return a * a.transpose();
}

Vec<2> direction(const Vec<1>& angles) { return {std::cos(angles[0]), std::sin(angles[0])}; }
Vec<3> direction(const Vec<2>& a) {
  return {std::cos(a[1]) * std::cos(a[0]), std::cos(a[1]) * std::sin(a[0]), std::sin(a[1])};
}

/// Compass search over the sphere from the best of many starts.
template <int Dim>
double brute_force(const Vec<Dim>& dp, const Mat<Dim>& covariance, double radius) {
  const Mat<Dim> information = covariance.inverse();
  const auto squared = [&](const Vec<Dim - 1>& angles) {
    const Vec<Dim> left = dp - radius * direction(angles);
    return left.dot(information * left);
  };
  Rng rng(1);
  Vec<Dim - 1> best = Vec<Dim - 1>::Zero();
  for (int i = 0; i < 2000; ++i) {
    Vec<Dim - 1> angles;
    for (int d = 0; d < Dim - 1; ++d) angles[d] = rng.uniform(-std::numbers::pi, std::numbers::pi);
    if (squared(angles) < squared(best)) best = angles;
  }
  for (double step = 0.1; step > 1e-11;) {
    bool improved = false;
    for (int k = 0; k < (Dim == 2 ? 2 : 8); ++k) {
      Vec<Dim - 1> next = best;
      const double turn = std::numbers::pi * k / 4;
      next[0] += Dim == 2 ? (k == 0 ? step : -step) : step * std::cos(turn);
      if constexpr (Dim == 3) next[1] += step * std::sin(turn);
      if (squared(next) < squared(best)) best = next, improved = true;
    }
    if (!improved) step /= 2;
  }
  return std::sqrt(squared(best));
}

template <int Dim>
void equals_brute_force() {
  Rng rng(7);
  for (int trial = 0; trial < 40; ++trial) {
    const Mat<Dim> covariance = long_and_thin<Dim>(rng);
    const double radius = rng.uniform(1, 20);
    const Vec<Dim> dp = normals<Dim>(rng, 40);
    if (dp.norm() <= radius) continue;
    const auto found = minimum_distance<Dim>(dp, covariance, radius);
    EXPECT_NEAR(found.mahalanobis, brute_force<Dim>(dp, covariance, radius), 1e-5 * (1 + found.mahalanobis));
    const double along =
        (found.normal.dot(dp) - radius) / std::sqrt(found.normal.dot(covariance * found.normal));
    EXPECT_NEAR(along, found.mahalanobis, 1e-8 * (1 + found.mahalanobis))
        << "the normal attains the distance";
  }
}
TEST(OverlapDistanceTest, MinimumEqualsBruteForceInThePlane) { equals_brute_force<2>(); }
TEST(OverlapDistanceTest, MinimumEqualsBruteForceInSpace) { equals_brute_force<3>(); }

template <int Dim>
void obeys_laws() {
  Rng rng(3);
  for (int trial = 0; trial < 2000; ++trial) {
    const Mat<Dim> covariance = long_and_thin<Dim>(rng);
    const double radius = rng.uniform(0, 20);
    const Vec<Dim> dp = normals<Dim>(rng, 40);
    const double least = minimum_distance<Dim>(dp, covariance, radius).mahalanobis;
    const double seed = line_of_sight_distance<Dim>(dp, covariance, radius);
    EXPECT_LE(least, seed * (1 + 1e-9));
    const Vec<Dim> u = dp.normalized();
    const Vec<Dim> q = std::max(0.0, dp.norm() - radius) * u;
    EXPECT_NEAR(seed, std::sqrt(q.dot(covariance.inverse() * q)), 1e-6 * (1 + seed)) << "Wi-Closure eq. 4.3";
    const Vec<Dim> any = normals<Dim>(rng, 1).normalized();
    EXPECT_GE(least * (1 + 1e-9) + 1e-9, (any.dot(dp) - radius) / std::sqrt(any.dot(covariance * any)));
    const Mat<Dim> round = Mat<Dim>::Identity() * 4;
    EXPECT_NEAR(minimum_distance<Dim>(dp, round, radius).mahalanobis, std::max(0.0, dp.norm() - radius) / 2,
                1e-9);
  }
}
TEST(OverlapDistanceTest, LawsHoldInThePlane) { obeys_laws<2>(); }
TEST(OverlapDistanceTest, LawsHoldInSpace) { obeys_laws<3>(); }

TEST(OverlapDistanceTest, IsZeroInsideTheBallWhateverTheCovariance) {
  EXPECT_EQ(minimum_distance<2>({3, 4}, Mat<2>::Zero(), 5).mahalanobis, 0);
  EXPECT_EQ(line_of_sight_distance<2>({3, 4}, Mat<2>::Zero(), 5), 0);
}

TEST(OverlapDistanceTest, SingularCovarianceExplainsOnlyItsOwnDirection) {
  const Mat<2> along_x = Vec<2>(4, 0).asDiagonal();
  constexpr double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(minimum_distance<2>({0, 10}, along_x, 5).mahalanobis, inf);
  EXPECT_EQ(minimum_distance<2>({30, 10}, along_x, 5).mahalanobis, inf);
  EXPECT_EQ(minimum_distance<2>({30, 10}, Mat<2>::Zero(), 5).mahalanobis, inf);
  EXPECT_EQ(line_of_sight_distance<2>({30, 3}, along_x, 5), inf);
  // The ball's point at y = 3 has x = 4: the remaining 26 m are 13 standard deviations of 2 m.
  EXPECT_NEAR(minimum_distance<2>({30, 3}, along_x, 5).mahalanobis, 13, 1e-9);
  EXPECT_NEAR(minimum_distance<2>({30, 5}, along_x, 5).mahalanobis, 15, 1e-9) << "touched at the top";
  EXPECT_NEAR(minimum_distance<2>({30, 5 - 1e-12}, along_x, 5).mahalanobis, 15, 1e-5);
  EXPECT_NEAR(minimum_distance<2>({30, 0}, along_x, 0).mahalanobis, 15, 1e-12) << "no range at all";
}

TEST(OverlapDistanceTest, HugeAndTinyCovariancesScale) {
  Rng rng(5);
  const Mat<3> covariance = long_and_thin<3>(rng);
  const Vec<3> dp(30, -40, 20);
  const double once = minimum_distance<3>(dp, covariance, 10).mahalanobis;
  for (const double scale : {1e-24, 1e-8, 1e8, 1e24})
    EXPECT_NEAR(minimum_distance<3>(dp, scale * covariance, 10).mahalanobis * std::sqrt(scale), once,
                1e-9 * once);
}

}  // namespace
}  // namespace radioslam
