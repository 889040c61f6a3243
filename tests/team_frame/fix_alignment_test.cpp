// Alignment by position fixes: exact for exact fixes, and robust to outliers.
#include "radioslam/team_frame/fix_alignment.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

const SE3 kT_fixes_start = lift(SE2(Eigen::Vector2d(400, -30), 2.2), 12);

/// Around a block of 60 m by 40 m, a fix every 2 m, without noise.
std::vector<FixAlongPath> fixes_around_a_block() {
  std::vector<FixAlongPath> fixes;
  for (int k = 0; k <= 100; ++k) {
    const double path_m = 2.0 * k;
    Eigen::Vector3d place(0, 0, 0.01 * path_m);
    if (path_m <= 60)
      place.x() = path_m;
    else if (path_m <= 100)
      place.head<2>() = Eigen::Vector2d(60, path_m - 60);
    else if (path_m <= 160)
      place.head<2>() = Eigen::Vector2d(160 - path_m, 40);
    else
      place.head<2>() = Eigen::Vector2d(0, 200 - path_m);
    fixes.push_back({place, kT_fixes_start * place, 1, path_m});
  }
  return fixes;
}

double angle_between(const SE3& a, const SE3& b) { return std::abs(wrap_angle(a.yaw() - b.yaw())); }

TEST(FixAlignment, IsExactWithoutNoise) {
  const auto found = align_by_fixes(fixes_around_a_block(), {});
  ASSERT_TRUE(found);
  const SE3& T = found->T_fixes_start;
  EXPECT_LT((T.translation() - kT_fixes_start.translation()).norm(), 1e-9);
  EXPECT_LT(angle_between(T, kT_fixes_start), 1e-12);
}

TEST(FixAlignment, FourFixesOfTenThatAreAnywhereDoNotTurnIt) {
  auto fixes = fixes_around_a_block();
  Rng rng(3);
  for (auto& fix : fixes) {
    const double sigma_m = rng.uniform() < 0.4 ? 100 : 1;
    for (int axis = 0; axis < 2; ++axis) fix.position_m(axis) += rng.normal(0, sigma_m);
  }
  const auto found = align_by_fixes(fixes, {});
  ASSERT_TRUE(found);
  const SE3& T = found->T_fixes_start;
  EXPECT_LT(angle_between(T, kT_fixes_start), 0.1);
  EXPECT_LT((T * fixes[50].by_odometry_m - kT_fixes_start * fixes[50].by_odometry_m).norm(), 4);
}

TEST(FixAlignment, FixesOfOnePlaceGiveNoHeading) {
  std::vector<FixAlongPath> fixes(20);
  Rng rng(4);
  for (auto& fix : fixes)
    for (int axis = 0; axis < 2; ++axis) fix.position_m(axis) = rng.normal(0, 1);
  EXPECT_FALSE(align_by_fixes(fixes, {}));
  EXPECT_FALSE(align_by_fixes({}, {}));
}

}  // namespace
}  // namespace radioslam
