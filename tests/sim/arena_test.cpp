#include "radioslam/sim/worlds/arena.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace radioslam {
namespace {

TEST(Arena, RobotsStopBeforeOuterWallsAndBoxes) {
  const Arena arena(40, 6, Rng(1));
  ASSERT_EQ(arena.boxes().size(), 6U);
  EXPECT_NEAR(arena.reach({5, 0.5}, {5, -10}).y(), 0.3, 1e-9);
  const ArenaBox& box = arena.boxes().front();
  const Eigen::Vector2d middle = (box.low_m + box.high_m) / 2, left(box.low_m.x() - 1, middle.y());
  const Eigen::Vector2d stopped = arena.reach(left, middle);
  EXPECT_NEAR(stopped.x(), box.low_m.x() - 0.3, 1e-9);
  EXPECT_NEAR(*arena.wall_ahead(left, 0, 3), 1, 1e-9);
  EXPECT_FALSE(arena.wall_ahead(left, 0, 0.5));
  EXPECT_FALSE(arena.in_sight(left, {box.high_m.x() + 1, middle.y()}));
}

TEST(Arena, PlacesAreFreeAndWalksStayOnTheFloor) {
  const Arena arena(30, 5, Rng(2));
  Rng rng(3);
  Eigen::Vector2d place = arena.free_place(rng);
  for (int k = 0; k < 5000; ++k) {
    place = arena.reach(place, arena.free_place(rng));
    EXPECT_GT(place.minCoeff(), 0);
    EXPECT_LT(place.maxCoeff(), 30);
    for (const ArenaBox& box : arena.boxes())
      EXPECT_FALSE((place.array() > box.low_m.array()).all() && (place.array() < box.high_m.array()).all());
  }
}

}  // namespace
}  // namespace radioslam
