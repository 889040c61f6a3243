// Rays against hand calculations, and the grid against testing every shape.
#include "radioslam/sim/worlds/ray_world.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace radioslam {
namespace {

constexpr double kFarAway_m = 1000;

Ray ray_towards(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  return {origin, direction.normalized()};
}

Eigen::Vector3d random_vector(double reach, Rng& rng) {
  const double x = rng.uniform(-reach, reach), y = rng.uniform(-reach, reach);
  return {x, y, rng.uniform(-reach, reach)};
}

TEST(RayWorld, HitsAWallAlongARay) {
  WorldShapes shapes;
  shapes.boxes.push_back(wall_between({4, -3}, {4, 3}, 0, 2));
  const RayWorld world(shapes);
  const auto ahead = world.cast(ray_towards({1, 0, 1}, {1, 0, 0}), kFarAway_m);
  ASSERT_TRUE(ahead);
  EXPECT_NEAR(ahead->range_m, 3, 1e-12);
  EXPECT_LT((ahead->normal - Eigen::Vector3d(-1, 0, 0)).norm(), 1e-12);
  const auto slanting = world.cast(ray_towards({1, 0, 1}, {3, 2, 0.5}), kFarAway_m);
  ASSERT_TRUE(slanting);
  EXPECT_NEAR(slanting->range_m, std::sqrt(9 + 4 + 0.25), 1e-12);
  EXPECT_FALSE(world.cast(ray_towards({1, 0, 1}, {3, 2, 1.1}), kFarAway_m)) << "passes over it";
  EXPECT_FALSE(world.cast(ray_towards({1, 0, 1}, {3, 3.1, 0}), kFarAway_m)) << "passes beside it";
  EXPECT_FALSE(world.cast(ray_towards({1, 0, 1}, {1, 0, 0}), 2.9)) << "too far away";
  EXPECT_FALSE(world.cast(ray_towards({1, 0, 1}, {-1, 0, 0}), kFarAway_m)) << "behind";
  const auto other_side = world.cast(ray_towards({6, 0, 1}, {-1, 0, 0}), kFarAway_m);
  ASSERT_TRUE(other_side);
  EXPECT_LT((other_side->normal - Eigen::Vector3d(1, 0, 0)).norm(), 1e-12);
}

TEST(RayWorld, HitsTheGroundAtAnElevation) {
  const double down_rad = 15 * std::numbers::pi / 180;
  const auto hit =
      RayWorld({}).cast({{7, -2, 1.8}, {0, std::cos(down_rad), -std::sin(down_rad)}}, kFarAway_m);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->range_m, 1.8 / std::sin(down_rad), 1e-9);
  EXPECT_LT((hit->normal - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  EXPECT_FALSE(RayWorld({}).cast({{0, 0, 1}, {1, 0, 0}}, kFarAway_m)) << "level";
}

TEST(RayWorld, HitsTheCeiling) {
  WorldShapes shapes;
  shapes.ceiling_m = 3;
  const auto hit = RayWorld(shapes).cast(ray_towards({0, 0, 1}, {2, 0, 1}), kFarAway_m);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->range_m, std::sqrt(20), 1e-12);
  EXPECT_LT((hit->normal + Eigen::Vector3d::UnitZ()).norm(), 1e-12);
}

TEST(RayWorld, HitsAPillarWhereItsCircleIs) {
  WorldShapes shapes;
  shapes.pillars.push_back({{5, 0}, 1, 0, 3});
  const RayWorld world(shapes);
  EXPECT_NEAR(world.cast(ray_towards({0, 0, 1}, {1, 0, 0}), kFarAway_m)->range_m, 4, 1e-12);
  const auto aside = world.cast(ray_towards({0, 0.6, 1}, {1, 0, 0}), kFarAway_m);  // 0.6, 0.8, 1
  ASSERT_TRUE(aside);
  EXPECT_NEAR(aside->range_m, 5 - 0.8, 1e-12);
  EXPECT_LT((aside->normal - Eigen::Vector3d(-0.8, 0.6, 0)).norm(), 1e-12);
  EXPECT_FALSE(world.cast(ray_towards({0, 1.01, 1}, {1, 0, 0}), kFarAway_m));
  const auto rising = world.cast(ray_towards({0, 0, 1}, {4, 0, 1}), kFarAway_m);
  ASSERT_TRUE(rising);
  EXPECT_NEAR(rising->range_m, std::sqrt(17), 1e-12);
  const auto from_above = world.cast(ray_towards({5, 0.5, 7}, {0, 0, -1}), kFarAway_m);
  ASSERT_TRUE(from_above);
  EXPECT_NEAR(from_above->range_m, 4, 1e-12);
  EXPECT_LT((from_above->normal - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
}

TEST(RayWorld, ABoxIsSolidFromOutsideAndARoomFromInside) {
  const double turn = 0.5;
  const Eigen::Vector2d forward(std::cos(turn), std::sin(turn)), left(-std::sin(turn), std::cos(turn));
  WorldShapes shapes;
  shapes.boxes.push_back({{10, 5}, forward, {3, 2}, 0, 4});
  const RayWorld world(shapes);
  const Eigen::Vector2d outside = Eigen::Vector2d(10, 5) - 7 * forward + 0.5 * left;
  const auto front = world.cast({{outside.x(), outside.y(), 1}, {forward.x(), forward.y(), 0}}, kFarAway_m);
  ASSERT_TRUE(front);
  EXPECT_NEAR(front->range_m, 4, 1e-12);
  EXPECT_LT((front->normal + Eigen::Vector3d(forward.x(), forward.y(), 0)).norm(), 1e-12);
  const auto inside = world.cast({{10, 5, 1}, {left.x(), left.y(), 0}}, kFarAway_m);
  ASSERT_TRUE(inside);
  EXPECT_NEAR(inside->range_m, 2, 1e-12);
  EXPECT_LT((inside->normal + Eigen::Vector3d(left.x(), left.y(), 0)).norm(), 1e-12);
  EXPECT_NEAR(world.cast({{10, 5, 1}, {0, 0, 1}}, kFarAway_m)->range_m, 3, 1e-12);
}

WorldShapes random_world(Rng rng) {
  WorldShapes shapes;
  for (int k = 0; k < 60; ++k) {
    const double turn = rng.uniform(0, 6), bottom = rng.uniform(-3, 3);
    const Eigen::Vector2d place = random_vector(50, rng).head<2>();
    const double along = rng.uniform(0.1, 6), across = k % 3 == 0 ? 0 : rng.uniform(0.1, 6);
    shapes.boxes.push_back(
        {place, {std::cos(turn), std::sin(turn)}, {along, across}, bottom, bottom + rng.uniform(0.5, 8)});
    const Eigen::Vector2d other = random_vector(50, rng).head<2>();
    shapes.pillars.push_back({other, rng.uniform(0.1, 3), bottom, bottom + rng.uniform(0.5, 8)});
  }
  shapes.boxes.push_back(wall_between({-80, 0.3}, {80, 0.3}, 0, 1));  // through many cells
  return shapes;
}

std::optional<double> nearest_of_all(const WorldShapes& shapes, const Ray& ray, double max_m) {
  std::optional<double> nearest = std::get<Hills>(shapes.ground).ray_m(ray.origin, ray.direction, max_m);
  const auto keep = [&](const std::optional<RayHit>& hit) {
    if (hit && hit->range_m <= nearest.value_or(max_m)) nearest = hit->range_m;
  };
  for (const auto& box : shapes.boxes) keep(ray_hit(ray, box));
  for (const auto& pillar : shapes.pillars) keep(ray_hit(ray, pillar));
  return nearest;
}

TEST(RayWorld, TheGridLosesNothing) {
  Rng rng(5);
  const WorldShapes shapes = random_world(rng.split("world"));
  const RayWorld world(shapes);
  int hits = 0;
  for (int k = 0; k < 20000; ++k) {
    Ray ray = ray_towards(random_vector(k % 2 == 0 ? 30 : 120, rng), random_vector(1, rng));
    if (k % 10 == 0) ray.direction = Eigen::Vector3d::Unit(k / 10 % 3) * (k / 30 % 2 == 0 ? 1 : -1);
    const double max_m = rng.uniform(1, 150);
    const auto hit = world.cast(ray, max_m);
    const auto expected = nearest_of_all(shapes, ray, max_m);
    ASSERT_EQ(hit.has_value(), expected.has_value()) << k;
    if (!hit) continue;
    ++hits;
    ASSERT_EQ(hit->range_m, *expected) << k;
    EXPECT_NEAR(hit->normal.norm(), 1, 1e-12);
    EXPECT_LE(hit->normal.dot(ray.direction), 0);
  }
  EXPECT_GT(hits, 3000);
}

/// The first of many small steps that is not above the ground.
std::optional<double> march_to_ground_m(const Hills& ground, const Ray& ray, double max_m, double step_m) {
  for (double way_m = 0; way_m <= max_m; way_m += step_m) {
    const Eigen::Vector3d place = ray.origin + way_m * ray.direction;
    if (place.z() <= ground.height_m(place.head<2>())) return way_m;
  }
  return std::nullopt;
}

TEST(Hills, RaysHitThemFirstWhereSmallStepsDo) {
  const Hills ground(12, Rng(3));
  Rng rng(8);
  constexpr double kMax_m = 400, kStep_m = 0.2;
  int hits = 0;
  for (int k = 0; k < 200; ++k) {
    Eigen::Vector3d origin = random_vector(300, rng);
    origin.z() = ground.height_m(origin.head<2>()) + rng.uniform(0.3, 6);
    const double azimuth = rng.uniform(0, 6.28), slope = rng.uniform(-0.15, 0.1);
    const Ray ray = ray_towards(origin, {std::cos(azimuth), std::sin(azimuth), slope});
    const auto range_m = ground.ray_m(ray.origin, ray.direction, kMax_m);
    const auto marched_m = march_to_ground_m(ground, ray, kMax_m, kStep_m);
    if (marched_m) {
      ASSERT_TRUE(range_m) << k;
    }
    if (!range_m) continue;
    ++hits;
    const Eigen::Vector3d place = ray.origin + *range_m * ray.direction;
    EXPECT_NEAR(place.z(), ground.height_m(place.head<2>()), 2e-6);
    // Where the ray is below the ground for less than a step's length, small steps may miss the hit.
    if (marched_m) {
      EXPECT_LE(*range_m, *marched_m + 1e-3) << k;
      EXPECT_FALSE(march_to_ground_m(ground, ray, *range_m - 1e-3, kStep_m)) << k;
    }
  }
  EXPECT_GT(hits, 100);
  EXPECT_FALSE(ground.ray_m({0, 0, ground.height_m({0, 0}) - 1}, {1, 0, 0}, kMax_m)) << "from below";
}

}  // namespace
}  // namespace radioslam
