#include "radioslam/places/stretches/stretch_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

/// A rectangular room of 8 m by 5 m with a recess on one side, scanned all around from two places.
double range_in_room(const Eigen::Vector2d& from, double angle_rad) {
  const Eigen::Vector2d ray(std::cos(angle_rad), std::sin(angle_rad));
  for (double range = 0.05;; range += 0.01) {
    const Eigen::Vector2d at = from + range * ray;
    const bool is_in_recess = at.x() > 5 && at.x() < 6.5 && at.y() >= 5 && at.y() < 6.2;
    if (!is_in_recess && (at.x() < 0 || at.x() > 8 || at.y() < 0 || at.y() > 5)) return range;
  }
}

StretchGrid room_seen_from(const SE2& T_room_grid) {
  std::vector<StretchView> views;
  for (const double x : {2.0, 5.5}) {
    const SE2 T_grid_scan = T_room_grid.inverse() * SE2({x, 2}, 0);
    StretchView& view = views.emplace_back(StretchView{T_grid_scan, {}});
    for (int k = 0; k < 360; ++k) {
      const double angle_rad = k * std::numbers::pi / 180;
      view.points.push_back(range_in_room({x, 2}, angle_rad) *
                            Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad)));
    }
  }
  return StretchGrid(views, 20);
}

const SE2 kA({2, 2}, 0.3), kB({5, 3}, -1.7);

TEST(StretchGrid, CoarserLevelsBoundEveryShiftWithinThem) {
  const StretchGrid grid = room_seen_from(kA);
  Rng rng(3);
  for (int trial = 0; trial < 2000; ++trial) {
    const Eigen::Vector2i cell(static_cast<int>(rng.uniform(-90, 90)),
                               static_cast<int>(rng.uniform(-90, 90)));
    for (int level = 1; level < StretchGrid::kLevels; ++level) {
      const int x = static_cast<int>(rng.uniform(0, 1 << level)),
                y = static_cast<int>(rng.uniform(0, 1 << level));
      EXPECT_LE(grid.value(0, cell + Eigen::Vector2i(x, y)), grid.value(level, cell));
    }
  }
}

TEST(StretchGrid, TellsWhatIsFreeFromWhatWasNotSeen) {
  const StretchGrid grid = room_seen_from(SE2());
  const auto at = [&](double x, double y) { return grid.value(0, StretchGrid::cell_of({x, y})); };
  EXPECT_EQ(at(4, 2.5), 0);
  EXPECT_GE(at(8, 2.5), StretchGrid::kNear);
  EXPECT_EQ(at(9.5, 2.5), StretchGrid::kUnseen);
  EXPECT_EQ(at(500, 2.5), StretchGrid::kUnseen);
}

TEST(StretchGrid, AgreesWithAnotherWhereTheyAreAndContradictsItElsewhere) {
  const StretchGrid a = room_seen_from(kA), b = room_seen_from(kB);
  const SE2 T_a_b = kA.inverse() * kB;
  EXPECT_GT(likeness(a, b, T_a_b).agreement(), 0.98);
  EXPECT_GT(likeness(a, b, T_a_b).seen(), 0.95);
  EXPECT_LT(likeness(a, b, T_a_b * SE2({1.5, 0}, 0)).agreement(), 0.8);
}

TEST(StretchSearch, FindsTheBestPoseThatTryingAllFinds) {
  const StretchGrid a = room_seen_from(kA), b = room_seen_from(kB);
  const SE2 T_a_b = kA.inverse() * kB;
  const SearchedStretch searched{
      &a, SE2(), T_a_b, std::numbers::pi, Eigen::Vector2d(-6, -6), Eigen::Vector2d(6, 6)};
  const auto found = search_stretches(b.occupied(), {searched}, {});
  ASSERT_FALSE(found.empty());
  EXPECT_LT((found[0].T_grid_points.translation() - T_a_b.translation()).norm(), 0.3);
  EXPECT_LT(std::abs(wrap_angle(found[0].T_grid_points.angle() - T_a_b.angle())), 0.05);
  double best = 0;
  for (double x = -6; x < 6; x += StretchGrid::kCell_m)
    for (double y = -6; y < 6; y += StretchGrid::kCell_m) {
      double sum = 0;
      for (const Eigen::Vector2d& point : b.occupied())
        sum += a.value(0, StretchGrid::cell_of(SE2({x, y}, found[0].T_grid_points.angle()) * point));
      best = std::max(best, StretchGrid::score(sum / static_cast<double>(b.occupied().size())));
    }
  EXPECT_GE(found[0].score, best - 0.02);
}

TEST(StretchSearch, SearchesAllStretchesAtOnceAndKeepsWhatIsTheSamePlaceOnce) {
  const StretchGrid a = room_seen_from(kA), b = room_seen_from(kB);
  const SE2 T_a_b = kA.inverse() * kB;
  const Eigen::Vector2d least(-6, -6), most(6, 6);
  const SE2 far({100, 0}, 0);
  const auto once = search_stretches(
      b.occupied(), {{&a, kA, T_a_b, 0.3, least, most}, {&a, kA, T_a_b, 0.3, least, most}}, {});
  const auto twice = search_stretches(
      b.occupied(), {{&a, kA, T_a_b, 0.3, least, most}, {&a, far, T_a_b, 0.3, least, most}}, {});
  ASSERT_EQ(once.size(), 1U);
  ASSERT_EQ(twice.size(), 2U);
  EXPECT_DOUBLE_EQ(twice[0].score, twice[1].score);
}

}  // namespace
}  // namespace radioslam
