#include "radioslam/lidar/surfels/surfel_columns.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

constexpr double kReach_m = 0.6;

Eigen::Vector3f scattered(const Eigen::Vector3d& extent, const Eigen::Vector3d& centre, Rng& rng) {
  const double x = rng.uniform(-extent.x(), extent.x()), y = rng.uniform(-extent.y(), extent.y());
  const double z = rng.uniform(-extent.z(), extent.z());
  return (centre + Eigen::Vector3d(x, y, z)).cast<float>();
}

std::vector<Surfel> surfels_within(const Eigen::Vector3d& extent, const Eigen::Vector3d& centre, int count,
                                   Rng& rng) {
  std::vector<Surfel> surfels;
  for (int k = 0; k < count; ++k)
    surfels.push_back({scattered(extent, centre, rng), Eigen::Matrix3f::Identity()});
  return surfels;
}

void expect_nearest(const SurfelColumns& columns, const Eigen::Vector3f& point, float max_distance_m) {
  float squared = std::numeric_limits<float>::infinity();
  for (const Surfel& surfel : columns.surfels())
    squared = std::min(squared, (surfel.position - point).squaredNorm());
  const float reach_m = std::min(max_distance_m, static_cast<float>(kReach_m));
  if (std::abs(std::sqrt(squared) - reach_m) < 1e-5F) return;
  const Surfel* found = columns.nearest(point, max_distance_m * max_distance_m);
  ASSERT_EQ(found != nullptr, squared < reach_m * reach_m) << point.transpose();
  if (found) {
    ASSERT_EQ((found->position - point).squaredNorm(), squared) << point.transpose();
  }
}

/// In a cube, in a plane, on a mast, and so thin that the columns must be wider.
TEST(SurfelColumns, FindTheNearestAsExhaustiveSearchDoes) {
  Rng rng(1);
  for (const Eigen::Vector3d& extent : {Eigen::Vector3d(2, 2, 2), Eigen::Vector3d(4, 4, 0),
                                        Eigen::Vector3d(0, 0, 30), Eigen::Vector3d(800, 800, 0)})
    for (const Eigen::Vector3d& centre : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(-300, 200, -10)}) {
      const SurfelColumns columns(surfels_within(extent, centre, 700, rng), kReach_m);
      const Eigen::Vector3d wider = extent.array() + 0.8;
      for (int n = 0; n < 700; ++n)
        for (const float max_distance_m : {0.6F, 0.25F, 5.0F})
          expect_nearest(columns, scattered(wider, centre, rng), max_distance_m);
    }
}

TEST(SurfelColumns, FindNothingFarAwayOrInNothing) {
  Rng rng(2);
  const SurfelColumns columns(surfels_within({2, 2, 2}, {0, 0, 0}, 100, rng), kReach_m);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Eigen::Vector3f& point : {Eigen::Vector3f(1e30F, 0, 0), Eigen::Vector3f(0, -1e9F, 0),
                                       Eigen::Vector3f(0, 0, 50), Eigen::Vector3f(nan, 0, 0)})
    EXPECT_EQ(columns.nearest(point, 1), nullptr);
  EXPECT_EQ(SurfelColumns({}, kReach_m).nearest({0, 0, 0}, 1), nullptr);
}

}  // namespace
}  // namespace radioslam
