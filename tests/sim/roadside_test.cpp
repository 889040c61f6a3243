// Streets made around a drive: nothing stands on it, and the ground is under it; the ground's grid alone.
#include "radioslam/sim/worlds/roadside.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

#include "radioslam/sim/worlds/path_ground.hpp"

namespace radioslam {
namespace {

using Path = std::vector<Eigen::Vector3d>;

constexpr double kReach_m = 30;

/// A winding drive uphill, and back beside it after a loop; `higher_m` above the first passage.
Path there_and_back(double higher_m) {
  Path path;
  const auto wave = [](double x) { return 8 * std::sin(x / 25); };
  const auto slope = [](double x) { return 0.05 * x; };
  for (double x = 0; x <= 200; x += 0.9) path.emplace_back(x, wave(x), slope(x));
  for (double turn = -0.5; turn <= 0.5; turn += 0.02) {
    const double angle = turn * std::numbers::pi;
    path.emplace_back(200 + 25 * std::cos(angle), wave(200) + 1.5 + 25 * std::sin(angle),
                      slope(200) + higher_m * (turn + 0.5));
  }
  for (double x = 200; x >= 0; x -= 1.1) path.emplace_back(x, wave(x) + 3, slope(x) + higher_m);
  return path;
}

WorldShapes roadside(const Path& path, std::uint64_t seed = 1) {
  return build_roadside(path, {}, kReach_m, Rng(seed));
}

TEST(Roadside, NothingStandsOnAnyPartOfTheDrive) {
  const RoadsideParams params;  // of the houses; trees are up to 0.3 widths from the drive
  for (const double higher_m : {0.0, 5.0}) {
    const Path path = there_and_back(higher_m);
    const WorldShapes shapes = roadside(path);
    EXPECT_GT(shapes.boxes.size(), 30U);
    EXPECT_GT(shapes.pillars.size(), 20U);
    for (const auto& place : path) {
      for (const auto& house : shapes.boxes)
        ASSERT_GT(floor_distance_m(house, place.head<2>()), 0.5 * params.houses.street_width_m);
      for (const auto& tree : shapes.pillars)
        ASSERT_GT(floor_distance_m(tree, place.head<2>()), 0.29 * params.houses.street_width_m);
    }
  }
}

TEST(Roadside, ShapesStandApartFromTheGroundUp) {
  const WorldShapes shapes = roadside(there_and_back(5));
  const auto& houses = shapes.boxes;
  const auto& ground = std::get<HeightGrid>(shapes.ground);
  for (std::size_t i = 0; i < houses.size(); ++i) {
    for (std::size_t j = i + 1; j < houses.size(); ++j) EXPECT_FALSE(overlap(houses[i], houses[j]));
    EXPECT_LT(houses[i].bottom_m, ground.height_m(houses[i].centre_m));
    EXPECT_GT(houses[i].top_m, ground.height_m(houses[i].centre_m) + 3);
    for (const auto& tree : shapes.pillars)
      EXPECT_GT(floor_distance_m(houses[i], tree.centre_m), tree.radius_m);
  }
}

TEST(Roadside, HousesFollowBothSidesOfTheDrive) {
  const Path path = there_and_back(0);
  const WorldShapes shapes = roadside(path);
  for (double x = 15; x <= 150; x += 5) {
    const Eigen::Vector2d place(x, 8 * std::sin(x / 25) + 1.5);
    int left = 0, right = 0;
    for (const auto& house : shapes.boxes)
      if (floor_distance_m(house, place) < 16) ++(house.centre_m.y() > place.y() ? left : right);
    EXPECT_GT(left, 0) << x;
    EXPECT_GT(right, 0) << x;
  }
}

TEST(Roadside, IsDeterminedByItsSeed) {
  const Path path = there_and_back(0);
  const auto first = roadside(path).boxes, again = roadside(path).boxes, other = roadside(path, 2).boxes;
  ASSERT_EQ(first.size(), again.size());
  for (std::size_t k = 0; k < first.size(); ++k) {
    EXPECT_EQ(first[k].centre_m, again[k].centre_m);
    EXPECT_EQ(first[k].top_m, again[k].top_m);
  }
  EXPECT_NE(first.front().half_size_m, other.front().half_size_m);
}

TEST(PathGround, IsUnderThePath) {
  const Path path = there_and_back(0);
  const HeightGrid ground = ground_under(path, kReach_m);
  for (const auto& place : path) EXPECT_NEAR(ground.height_m(place.head<2>()), place.z(), 0.4);
}

TEST(PathGround, FollowsTheLowestOfPassagesThatDisagree) {
  const Path path = there_and_back(5);
  const HeightGrid ground = ground_under(path, kReach_m);
  for (const auto& place : path) {
    EXPECT_LT(ground.height_m(place.head<2>()), place.z() + 0.6);
    if (place.x() < 170) {
      EXPECT_NEAR(ground.height_m(place.head<2>()), 0.05 * place.x(), 0.6);
    }
  }
}

TEST(PathGround, OfOnePlaceIsLevel) {
  const HeightGrid ground = ground_under({{3, 4, 5}}, kReach_m);
  for (const Eigen::Vector2d& place : {Eigen::Vector2d(3, 4), Eigen::Vector2d(33, -26)})
    EXPECT_NEAR(ground.height_m(place), 5, 1e-12);
}

/// Rough ground around the origin, with cells of 2 m.
HeightGrid rough_ground() {
  Rng rng(4);
  return {{-41, -39}, 2, Eigen::MatrixXd::NullaryExpr(42, 40, [&] { return rng.uniform(-1, 1); })};
}

TEST(HeightGrid, InterpolatesBetweenItsHeights) {
  const HeightGrid ground({10, 20}, 2, (Eigen::MatrixXd(2, 2) << 1, 3, 2, 8).finished());
  EXPECT_EQ(ground.height_m({10, 20}), 1);
  EXPECT_EQ(ground.height_m({12, 20}), 2);
  EXPECT_EQ(ground.height_m({10, 22}), 3);
  EXPECT_EQ(ground.height_m({12, 22}), 8);
  EXPECT_EQ(ground.height_m({11, 21}), 3.5);
  EXPECT_EQ(ground.height_m({99, 22}), 8) << "as at the border";
  EXPECT_LT((ground.gradient({11, 21}) - Eigen::Vector2d(1.5, 2)).norm(), 1e-12);
}

TEST(HeightGrid, RaysHitItFirstWhereSmallStepsDo) {
  const HeightGrid ground = rough_ground();
  Rng rng(8);
  constexpr double kMax_m = 40, kStep_m = 0.01;
  int hits = 0;
  for (int k = 0; k < 400; ++k) {
    Eigen::Vector3d origin(rng.uniform(-30, 30), rng.uniform(-30, 30), 0);
    origin.z() = ground.height_m(origin.head<2>()) + rng.uniform(0.1, 2);
    const double azimuth = rng.uniform(0, 2 * std::numbers::pi), climb = rng.uniform(-0.5, 0.2);
    const Eigen::Vector3d direction =
        Eigen::Vector3d(std::cos(azimuth), std::sin(azimuth), climb).normalized();
    const auto above_m = [&](double along_m) {
      const Eigen::Vector3d place = origin + along_m * direction;
      return place.z() - ground.height_m(place.head<2>());
    };
    const auto hit_m = ground.ray_m(origin, direction, kMax_m);
    const double reached_m = hit_m.value_or(5);  // then still over the grid
    for (double along_m = 0; along_m < reached_m - 1e-6; along_m += kStep_m)
      ASSERT_GT(above_m(along_m), 0) << k << " at " << along_m;
    if (!hit_m) continue;
    ++hits;
    EXPECT_NEAR(above_m(*hit_m), 0, 1e-9) << k;
  }
  EXPECT_GT(hits, 200);
}

TEST(HeightGrid, RaysAlongItsLinesAndStraightDownHit) {
  const HeightGrid ground({0, 0}, 1, Eigen::MatrixXd::Constant(5, 5, 2));
  EXPECT_NEAR(*ground.ray_m({1, 1, 3}, {0, 0, -1}, 10), 1, 1e-12);
  EXPECT_NEAR(*ground.ray_m({1, 1, 3}, Eigen::Vector3d(2, 0, -1).normalized(), 10), std::sqrt(5), 1e-12);
  EXPECT_NEAR(*ground.ray_m({3, 3, 3}, Eigen::Vector3d(-2, -2, -1).normalized(), 10), 3, 1e-12);
}

TEST(HeightGrid, HasNoHitFromBelowBeyondTheRangeOrBesideIt) {
  const HeightGrid ground({0, 0}, 1, Eigen::MatrixXd::Constant(5, 5, 2));
  EXPECT_FALSE(ground.ray_m({1, 1, 1}, {0, 0, 1}, 10)) << "from below";
  EXPECT_FALSE(ground.ray_m({1, 1, 9}, {0, 0, -1}, 6)) << "beyond the range";
  EXPECT_FALSE(ground.ray_m({1, 1, 3}, {1, 0, 0}, 10)) << "level";
  EXPECT_FALSE(ground.ray_m({1, 1, 3}, Eigen::Vector3d(9, 0, -1).normalized(), 20)) << "beyond its border";
  EXPECT_FALSE(ground.ray_m({-1, 1, 3}, {0, 0, -1}, 10)) << "beside it";
}

TEST(UprightShapes, DistanceAndOverlapOnTheFloor) {
  const double side = std::sqrt(0.5);
  const UprightBox upright{{0, 0}, {1, 0}, {2, 1}, 0, 1}, turned{{5, 0}, {side, side}, {2, 2}, 0, 1};
  EXPECT_EQ(floor_distance_m(upright, {1, -0.5}), 0) << "inside";
  EXPECT_NEAR(floor_distance_m(upright, {5, 5}), 5, 1e-12) << "from its corner";
  EXPECT_NEAR(floor_distance_m(UprightPillar{{3, 4}, 1, 0, 1}, {0, 0}), 4, 1e-12);
  EXPECT_FALSE(overlap(upright, turned)) << "its corner is at 2.17";
  EXPECT_TRUE(overlap(upright, {{4.8, 0}, {side, side}, {2, 2}, 0, 1}));
  EXPECT_FALSE(overlap({{0, 0}, {1, 0}, {1, 1}, 0, 1}, {{2, 2}, {side, side}, {1, 1}, 0, 1}))
      << "only the turned sides separate them";
}

}  // namespace
}  // namespace radioslam
