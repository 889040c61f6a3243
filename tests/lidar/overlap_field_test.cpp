#include "radioslam/lidar/overlap_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

constexpr double kReach_m = 2;

Surfel surfel_at(const Eigen::Vector3d& position) {
  return {position.cast<float>(), Eigen::Matrix3f::Identity()};
}

double score(const OverlapField& field, const std::vector<Surfel>& points, const Eigen::Vector3d& place) {
  return field.scores(points, Eigen::Quaterniond::Identity(), {place}).front();
}

/// f(d) = 1 / (1 + 16 d^2 / D^2) in whole voxels of D / 8.
TEST(OverlapField, OfOnePointIsTheKernelOfItsDistance) {
  const std::vector<Surfel> one{surfel_at({0.1, 0.1, 0.1})};
  const OverlapField field(one, kReach_m);
  EXPECT_EQ(score(field, one, {0, 0, 0}), 1);
  for (const int axis : {0, 1, 2})
    for (const int side : {-1, 1})
      for (int steps = 1; steps < 10; ++steps) {
        const double off_m = side * steps * kReach_m / 8;
        const double expected = steps < 8 ? 1 / (1 + 16 * off_m * off_m / (kReach_m * kReach_m)) : 0;
        EXPECT_NEAR(score(field, one, off_m * Eigen::Vector3d::Unit(axis)), expected, 0.5 / 255);
      }
  EXPECT_NEAR(score(field, one, {0.25, 0.5, -0.75}), 1 / (1 + 16.0 * 14 / 64), 0.5 / 255);
  EXPECT_EQ(score(field, one, {1e12, 0, 0}), 0);
}

TEST(OverlapField, TurnsBeforeItShifts) {
  const OverlapField field({surfel_at({3.1, 5.1, 0.1})}, kReach_m);
  const Eigen::Quaterniond left(0, 0, 0, 1);  // half a turn
  EXPECT_EQ(field.scores({surfel_at({-2.1, -4.1, 0.1})}, left, {{1, 1, 0}}).front(), 1);
}

/// Against the distances themselves, which the voxels blur by up to a diagonal.
TEST(OverlapField, IsNearTheMeanOverExactDistances) {
  Rng rng(3);
  std::vector<Surfel> map, points;
  const auto anywhere = [&] {
    const double x = rng.uniform(-6, 6), y = rng.uniform(-6, 6);
    return surfel_at({x, y, rng.uniform(-2, 2)});
  };
  for (int k = 0; k < 150; ++k) map.push_back(anywhere());
  for (int k = 0; k < 300; ++k) points.push_back(anywhere());
  const OverlapField field(map, kReach_m);
  for (int n = 0; n < 20; ++n) {
    const double x = rng.uniform(-3, 3);
    const Eigen::Vector3d place(x, rng.uniform(-3, 3), 0);
    double sum = 0;
    for (const Surfel& point : points) {
      double squared = kReach_m * kReach_m;
      for (const Surfel& surfel : map)
        squared = std::min(
            squared, (surfel.position.cast<double>() - point.position.cast<double>() - place).squaredNorm());
      if (squared < kReach_m * kReach_m) sum += 1 / (1 + 16 * squared / (kReach_m * kReach_m));
    }
    EXPECT_NEAR(score(field, points, place), sum / 300, 0.03);
  }
}

/// Two points kilometres apart would need billions of voxels.
TEST(OverlapField, OfAWideMapIsCoarser) {
  const std::vector<Surfel> far{surfel_at({-4e3, -4e3, 0}), surfel_at({4e3, 4e3, 100})};
  const OverlapField field(far, kReach_m);
  EXPECT_EQ(score(field, far, {0, 0, 0}), 1);
}

TEST(OverlapField, OfNothingIsZero) {
  EXPECT_EQ(score(OverlapField({}, kReach_m), {surfel_at({0, 0, 0})}, {0, 0, 0}), 0);
  EXPECT_EQ(score(OverlapField({surfel_at({0, 0, 0})}, kReach_m), {}, {0, 0, 0}), 0);
}

}  // namespace
}  // namespace radioslam
