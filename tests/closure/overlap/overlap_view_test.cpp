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

ViewSector disc(double x_m, double range_m) { return {{x_m, 0}, 0, kPi, range_m}; }
ViewSector half_disc(const Eigen::Vector2d& apex_m, double heading_rad) {
  return {apex_m, heading_rad, kPi / 2, 30};
}

/// Common area of two discs of 30 m.
double lens_m2(double distance_m) {
  return 1800 * std::acos(distance_m / 60) - distance_m / 2 * std::sqrt(3600 - distance_m * distance_m);
}
double over_union(double common_m2, double area_m2) { return common_m2 / (2 * area_m2 - common_m2); }

ViewSector draw_sector(Rng& rng) {
  return {{rng.uniform(-10, 10), rng.uniform(-10, 10)},
          rng.uniform(-4, 4),
          rng.uniform(0.05, 3.6),
          rng.uniform(5, 15)};
}

TEST(SharedViewTest, OfEqualDiscsHasAClosedForm) {
  for (const double distance_m : {0.0, 1.0, 20.0, 35.0, 59.9})
    EXPECT_NEAR(shared_view(disc(0, 30), disc(distance_m, 30)), over_union(lens_m2(distance_m), 900 * kPi),
                1e-12);
  EXPECT_NEAR(shared_view(disc(0, 30), disc(35, 30)), 0.18, 0.003) << "the published rule";
  EXPECT_EQ(shared_view(disc(0, 30), disc(60, 30)), 0);
}

TEST(SharedViewTest, OfADiscInAnotherIsTheRatioOfTheirAreas) {
  for (const double distance_m : {0.0, 7.0, 20.0})
    EXPECT_NEAR(shared_view(disc(0, 30), disc(distance_m, 10)), 1.0 / 9, 1e-12);
}

TEST(SharedViewTest, OfHalfDiscsDependsOnTheirHeadings) {
  constexpr double kAccuracy = 1e-3, kArea = 450 * kPi;
  const ViewSector east = half_disc({0, 0}, 0);
  EXPECT_NEAR(shared_view(east, half_disc({0, 0}, 0)), 1, kAccuracy);
  EXPECT_NEAR(shared_view(east, half_disc({0, 0}, kPi)), 0, kAccuracy);
  EXPECT_NEAR(shared_view(east, half_disc({0, 0}, kPi / 2)), 1.0 / 3, kAccuracy) << "a quarter in common";
  EXPECT_NEAR(shared_view(east, half_disc({40, 0}, kPi)), over_union(lens_m2(40), kArea), kAccuracy)
      << "face to face, all that the discs have in common is in both";
  EXPECT_NEAR(shared_view(east, half_disc({-40, 0}, kPi)), 0, kAccuracy) << "back to back";
  EXPECT_NEAR(shared_view(east, half_disc({0, 40}, 0)), over_union(lens_m2(40) / 2, kArea), kAccuracy)
      << "side by side, half of it";
  EXPECT_NEAR(shared_view(east, disc(0, 30)), 0.5, kAccuracy);
}

TEST(SharedViewTest, WithoutAreaIsNothing) {
  EXPECT_EQ(shared_view(disc(0, 0), disc(0, 0)), 0);
  EXPECT_EQ(shared_view(disc(0, 30), disc(0, 0)), 0);
  EXPECT_EQ(shared_view({{0, 0}, 0, 0, 30}, disc(0, 30)), 0);
}

/// Common area by points of a, each of which stands for the piece of a around it.
double common_by_points_m2(const ViewSector& a, const ViewSector& b) {
  constexpr int kSteps = 200;
  const double half = std::min(a.half_angle_rad, kPi);
  double sum = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const double range_m = a.range_m * (i + 0.5) / kSteps;
      const double angle = a.heading_rad + half * ((2 * j + 1.0) / kSteps - 1);
      const Eigen::Vector2d p = a.apex_m + range_m * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      if (sector_distance(b, {p, 0, kPi, 0}) == 0) sum += range_m;
    }
  return sum * (2 * half / kSteps) * (a.range_m / kSteps);
}

TEST(SharedViewTest, EqualsTheShareOfManyPointsFromEitherSide) {
  Rng rng(12);
  for (int trial = 0; trial < 60; ++trial) {
    const ViewSector a = draw_sector(rng), b = draw_sector(rng);
    const auto area_m2 = [](const ViewSector& s) {
      return std::min(s.half_angle_rad, kPi) * s.range_m * s.range_m;
    };
    const double common = common_by_points_m2(a, b);
    EXPECT_NEAR(shared_view(a, b), common / (area_m2(a) + area_m2(b) - common), 0.01) << trial;
    EXPECT_NEAR(shared_view(a, b), shared_view(b, a), 2e-3) << trial;
  }
}

TEST(MaxSharedViewTest, IsAtLeastThatOfEveryDisplacementAndTurnWithinItsBounds) {
  Rng rng(13);
  for (int trial = 0; trial < 400; ++trial) {
    const ViewSector a = draw_sector(rng), b = draw_sector(rng);
    const double offset_m = rng.uniform(0, 5), turn_rad = rng.uniform(0, 0.6);
    ViewSector moved = b;
    const double direction = rng.uniform(-kPi, kPi);
    moved.apex_m += rng.uniform(0, offset_m) * Eigen::Vector2d(std::cos(direction), std::sin(direction));
    moved.heading_rad += rng.uniform(-turn_rad, turn_rad);
    EXPECT_GE(max_shared_view(a, b, offset_m, turn_rad), shared_view(a, moved) - 1e-3) << trial;
    EXPECT_EQ(max_shared_view(a, b, 0, 0), shared_view(a, b));
  }
}

TEST(MaxDistanceOfSharedViewTest, IsTheInverseOfTheSharedView) {
  for (const double range_m : {14.0, 20.0, 30.0})
    for (const double share : {1e-6, 0.01, 0.18, 0.2}) {
      const auto distance_m = max_distance_of_shared_view(30, range_m, share);
      ASSERT_TRUE(distance_m.has_value());
      EXPECT_NEAR(shared_view(disc(0, 30), disc(*distance_m, range_m)), share, 1e-9);
    }
  EXPECT_NEAR(*max_distance_of_shared_view(30, 30, 0.18), 35, 0.2) << "the published rule";
}

TEST(MaxDistanceOfSharedViewTest, Limits) {
  EXPECT_EQ(max_distance_of_shared_view(30, 17.3, 0), 30 + 17.3) << "the discs touch";
  EXPECT_EQ(max_distance_of_shared_view(30, 30, 1), 0) << "nothing less than the same place";
  EXPECT_FALSE(max_distance_of_shared_view(30, 10, 0.12).has_value()) << "concentric discs share a ninth";
  EXPECT_TRUE(max_distance_of_shared_view(30, 10, 0.11).has_value());
  EXPECT_FALSE(max_distance_of_shared_view(0, 0, 0.1).has_value());
}

TEST(MaxDistanceOfSharedViewTest, BeyondItNoHeadingsOfSectorsShareAsMuch) {
  const OverlapSensor a{30, kPi}, b{25, 2};
  const auto distance_m = max_distance_of_shared_view(a, b, 0.18);
  ASSERT_TRUE(distance_m.has_value());
  const auto at = [&](double x_m, double heading_a, double heading_b) {
    return shared_view({{0, 0}, heading_a, a.view_rad / 2, a.range_m},
                       {{x_m, 0}, heading_b, b.view_rad / 2, b.range_m});
  };
  EXPECT_NEAR(at(*distance_m, 0, kPi), 0.18, 1e-3) << "face to face they do";
  Rng rng(14);
  for (int trial = 0; trial < 200; ++trial)
    EXPECT_LT(at(*distance_m + 1, rng.uniform(-kPi, kPi), rng.uniform(-kPi, kPi)), 0.18);
  EXPECT_GT(*distance_m, *max_distance_of_shared_view(30, 25, 0.18)) << "discs have more to share";
}

}  // namespace
}  // namespace radioslam
