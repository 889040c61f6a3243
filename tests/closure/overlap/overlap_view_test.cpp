#include "radioslam/closure/overlap/overlap_view.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

constexpr double kPi = std::numbers::pi;

std::vector<Eigen::Vector2d> points_of(const ViewSector& s) {
  constexpr int kSteps = 40;
  std::vector<Eigen::Vector2d> points;
  const double half = std::min(s.half_angle_rad, kPi);
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; j <= kSteps; ++j) {
      const double angle = s.heading_rad + half * (2.0 * j / kSteps - 1);
      points.push_back(s.apex_m + s.range_m * i / kSteps * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
  return points;
}

TEST(SectorDistanceTest, EqualsTheLeastDistanceOfManyPoints) {
  Rng rng(11);
  for (int trial = 0; trial < 60; ++trial) {
    const auto draw = [&] {
      return ViewSector{{rng.uniform(-25, 25), rng.uniform(-25, 25)},
                        rng.uniform(-4, 4),
                        rng.uniform(0.05, 3.6),
                        rng.uniform(5, 15)};
    };
    const ViewSector a = draw(), b = draw();
    double least = std::numeric_limits<double>::infinity();
    const auto of_b = points_of(b);
    for (const auto& p : points_of(a))
      for (const auto& q : of_b) least = std::min(least, (p - q).squaredNorm());
    const double found = sector_distance(a, b);
    EXPECT_LE(found, std::sqrt(least) + 1e-9);
    EXPECT_GE(found, std::sqrt(least) - 1.7) << "points are up to 1.2 m apart";
    EXPECT_DOUBLE_EQ(found, sector_distance(b, a));
  }
}

TEST(SectorDistanceTest, KnownCases) {
  const ViewSector east{{0, 0}, 0, kPi / 4, 10}, far_west{{30, 0}, kPi, kPi / 4, 10};
  EXPECT_NEAR(sector_distance(east, far_west), 10, 1e-12) << "arc to arc";
  const ViewSector back_to_back{{-5, 0}, kPi, kPi / 4, 10};
  EXPECT_NEAR(sector_distance(east, back_to_back), 5, 1e-12) << "apex to apex";
  const ViewSector disc{{0, 20}, 0, kPi, 5};
  EXPECT_NEAR(sector_distance(east, disc), std::sqrt(50 + std::pow(20 - std::sqrt(50), 2)) - 5, 1e-12);
  const ViewSector all{{0, 0}, 0, 2 * kPi, 10};
  EXPECT_NEAR(sector_distance(all, disc), 5, 1e-12);
  const ViewSector crossing{{5, -20}, kPi / 2, 0.1, 40};
  EXPECT_EQ(sector_distance(east, crossing), 0);
  const ViewSector inside{{5, 0}, 1, 0.1, 0.5};
  EXPECT_EQ(sector_distance(east, inside), 0);
}

}  // namespace
}  // namespace radioslam
