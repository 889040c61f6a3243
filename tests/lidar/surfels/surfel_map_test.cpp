#include "radioslam/lidar/surfels/surfel_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

constexpr double kSurfelSpacing_m = 0.2, kSurfelReach_m = 0.6;

std::vector<Surfel> scattered(double max_distance_m, int count, Rng& rng, const Eigen::Vector3f& centre) {
  std::vector<Surfel> surfels;
  for (int k = 0; k < count; ++k) {
    const double x = rng.uniform(-max_distance_m, max_distance_m),
                 y = rng.uniform(-max_distance_m, max_distance_m);
    const double z = rng.uniform(-max_distance_m, max_distance_m);
    surfels.push_back({centre + Eigen::Vector3d(x, y, z).cast<float>(), Eigen::Matrix3f::Identity()});
  }
  return surfels;
}

/// Distance to the nearest of all surfels, by exhaustive search.
double nearest_distance_m(const std::vector<Surfel>& surfels, const Eigen::Vector3f& point) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Surfel& surfel : surfels)
    nearest = std::min(nearest, (surfel.position - point).cast<double>().norm());
  return nearest;
}

/// Compares nearest() with an exhaustive search.
void expect_nearest(const SurfelMap& map, const Eigen::Vector3f& point, double max_distance_m) {
  const double expected = nearest_distance_m(map.surfels(), point);
  const Surfel* found = map.nearest(point, static_cast<float>(max_distance_m * max_distance_m));
  const double reach = std::min(max_distance_m, map.max_distance_m());
  if (std::abs(expected - reach) < 1e-5) return;
  ASSERT_EQ(found != nullptr, expected < reach) << point.transpose() << ", " << expected << " away";
  if (found) {
    ASSERT_NEAR((found->position - point).cast<double>().norm(), expected, 1e-5) << point.transpose();
  }
}

TEST(SurfelMap, FindsTheNearestAsExhaustiveSearchDoes) {
  Rng rng(1);
  for (const Eigen::Vector3f& centre : {Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(-300, 200, -10)}) {
    SurfelMap map(kSurfelSpacing_m, kSurfelReach_m);
    map.add(scattered(2, 700, rng, centre), 0);
    for (const Surfel& probe : scattered(2.8, 700, rng, centre))
      for (const double max_distance_m : {kSurfelReach_m, 0.25, 5.0})
        expect_nearest(map, probe.position, max_distance_m);
  }
}

/// A point seen from a distance becomes a planar surfel when seen from nearby, and stays one.
TEST(SurfelMap, LearnsTheSurfaceOfAPoint) {
  SurfelMap map(kSurfelSpacing_m, kSurfelReach_m);
  const Eigen::Vector3f place(1.19F, 0, 0), beside(1.21F, 0, 0);  // in two cells
  const Surfel point{place, 4e-4F * Eigen::Matrix3f::Identity(), 0, SurfelShape::kIsolated};
  const Surfel surface{beside, Eigen::Vector3f(1e-3F, 1, 1).asDiagonal(), 0.01F, SurfelShape::kSurface};
  const Surfel blob{beside, Eigen::Vector3f(1e-3F, 1e-3F, 1).asDiagonal(), 0, SurfelShape::kUnstructured};
  EXPECT_EQ(map.add({point}, 0), 1U);
  EXPECT_EQ(map.add({blob}, 0), 0U);
  EXPECT_EQ(map.surfels()[0].shape, SurfelShape::kIsolated);  // vertical lines on walls would be poles
  EXPECT_EQ(map.add({surface}, 0), 0U);
  EXPECT_EQ(map.add({point, blob}, 0), 0U);
  const auto surfels = map.surfels();
  ASSERT_EQ(surfels.size(), 1U);
  EXPECT_EQ(surfels[0].position, place);
  EXPECT_EQ(surfels[0].covariance, surface.covariance);
  EXPECT_EQ(surfels[0].shape, SurfelShape::kSurface);
  EXPECT_EQ(surfels[0].tilt_rad2, surface.tilt_rad2);
}

TEST(SurfelMap, FindsAcrossTheCornersOfItsCells) {
  for (int corner = 0; corner < 8; ++corner) {
    SurfelMap map(kSurfelSpacing_m, kSurfelReach_m);
    const Eigen::Vector3f side((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1,
                               (corner & 4) != 0 ? 1 : -1);
    for (const float off_m : {0.01F, 0.1F, 0.3F}) {
      map.add({{off_m * side, Eigen::Matrix3f::Identity()}}, 0);
      for (const float at_m : {0.001F, 0.03F, 0.2F}) {
        expect_nearest(map, -at_m * side, kSurfelReach_m);
        expect_nearest(map, at_m * side, kSurfelReach_m);
      }
    }
  }
}

TEST(SurfelMap, KeepsItsSurfelsApartAndLeavesNoGap) {
  Rng rng(2);
  SurfelMap map(kSurfelSpacing_m, kSurfelReach_m);
  const auto added = scattered(1, 5000, rng, {0.1F, 0, 0});
  for (std::size_t k = 0; k < added.size(); k += 500)
    map.add({added.begin() + static_cast<std::ptrdiff_t>(k),
             added.begin() + static_cast<std::ptrdiff_t>(k) + 500},
            0);
  const auto kept = map.surfels();
  ASSERT_EQ(kept.size(), map.size());
  for (std::size_t a = 0; a < kept.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      ASSERT_GT((kept[a].position - kept[b].position).norm(), 0.7 * kSurfelSpacing_m - 1e-5);
  for (const Surfel& surfel : added)
    ASSERT_LT(nearest_distance_m(kept, surfel.position), 0.7 * kSurfelSpacing_m);
  for (const Surfel& surfel : kept)
    ASSERT_TRUE(std::any_of(added.begin(), added.end(),
                            [&](const Surfel& a) { return a.position == surfel.position; }));
}

TEST(SurfelMap, AddsNothingTwice) {
  Rng rng(3);
  SurfelMap map(kSurfelSpacing_m, kSurfelReach_m);
  const auto surfels = scattered(2, 500, rng, {0, 0, 0});
  map.add(surfels, 0);
  const std::size_t size = map.size();
  map.add(surfels, 1);
  EXPECT_EQ(map.size(), size);
}

/// Rows of surfels a metre apart, so that each has cells of its own.
std::vector<Surfel> row_at(float x) {
  std::vector<Surfel> row;
  for (int k = 0; k < 40; ++k) row.push_back({{x, static_cast<float>(k), 0}, Eigen::Matrix3f::Identity()});
  return row;
}

TEST(SurfelMap, ForgetsWhatWasOutOfSightAndNothingElse) {
  SurfelMap map(kSurfelSpacing_m, kSurfelReach_m);
  for (int n = 0; n < 10; ++n) map.add(row_at(static_cast<float>(10 * n)), 10.0 * n);
  map.add(row_at(20), 95);  // seen again: nothing is added, but its time of sight is renewed
  ASSERT_EQ(map.size(), 400U);
  map.forget_before(50);
  EXPECT_EQ(map.size(), 240U);
  for (int n = 0; n < 10; ++n) {
    const bool remembered = n >= 5 || n == 2;
    for (const Surfel& surfel : row_at(static_cast<float>(10 * n)))
      ASSERT_EQ(map.nearest(surfel.position, 0.01F) != nullptr, remembered) << n;
  }
  map.forget_before(50);
  EXPECT_EQ(map.size(), 240U);
  map.forget_before(1000);
  EXPECT_TRUE(map.empty());
  EXPECT_TRUE(map.surfels().empty());
  EXPECT_EQ(map.nearest({0, 0, 0}, 1), nullptr);
}

TEST(SurfelMap, AfterForgettingStillFindsTheNearest) {
  Rng rng(4);
  SurfelMap map(kSurfelSpacing_m, kSurfelReach_m);
  for (int n = 0; n < 40; ++n) {  // a path of 40 m, with enough cells for the table to grow
    const Eigen::Vector3f centre(static_cast<float>(n), 0, static_cast<float>(-n));
    map.add(scattered(3, 400, rng, centre), n);
    map.forget_before(n - 5);
  }
  for (const Surfel& probe : scattered(9, 1000, rng, {36, 0, -36}))
    expect_nearest(map, probe.position, kSurfelReach_m);
}

TEST(SurfelMap, OfNothingFindsNothing) {
  const SurfelMap map(kSurfelSpacing_m, kSurfelReach_m);
  EXPECT_TRUE(map.empty());
  EXPECT_EQ(map.size(), 0U);
  EXPECT_EQ(map.nearest({1, 2, 3}, 100), nullptr);
}

}  // namespace
}  // namespace radioslam
