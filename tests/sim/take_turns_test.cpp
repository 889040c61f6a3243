#include "radioslam/sim/motion/take_turns.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace radioslam {
namespace {

/// Walls all around a square of ten metres.
double to_walls_m(const Eigen::Vector2d& place) {
  return std::min({place.x(), 10 - place.x(), place.y(), 10 - place.y()});
}

const std::vector<SE2> kStarts{SE2({2, 2}, 0), SE2({5, 5}, 1), SE2({8, 3}, 2)};

TEST(TurnDrives, OneDrivesWhileTheOthersRest) {
  const auto legs = draw_turns(kStarts, to_walls_m, {}, Rng(1));
  ASSERT_EQ(legs.size(), 24U);
  double before_s = 0;
  for (std::size_t k = 0; k < legs.size(); ++k) {
    EXPECT_EQ(legs[k].robot, k % 3);
    EXPECT_NEAR(legs[k].begin_s - before_s, 1, 1e-9);
    before_s = legs[k].end_s;
    const double arcs_m = legs[k].arcs[0].length_m + legs[k].arcs[1].length_m;
    EXPECT_GE(arcs_m, 1);
    EXPECT_LE(arcs_m, 2);
    EXPECT_NEAR(legs[k].effort_m() / (legs[k].end_s - legs[k].begin_s), 0.2, 1e-9);
  }
  for (double t_s = 0; t_s < before_s + 2; t_s += 0.1) {
    int moving = 0;
    for (std::size_t r = 0; r < 3; ++r) {
      const SE2 now = pose_in_turns(legs, r, kStarts[r], t_s);
      const SE2 later = pose_in_turns(legs, r, kStarts[r], t_s + 0.01);
      const double moved = (now.inverse() * later).log().norm();
      EXPECT_LT(moved, 0.025) << "no jumps: at most 0.4 m/s or 1.3 rad/s, and 1.5 rad/m";
      if (moved > 1e-12) ++moving;
      EXPECT_GT(to_walls_m(now.translation()), 0.75);
      for (std::size_t other = 0; other < r; ++other)
        EXPECT_GT((now.translation() - pose_in_turns(legs, other, kStarts[other], t_s).translation()).norm(),
                  0.75);
    }
    EXPECT_LE(moving, 1) << t_s;
  }
  EXPECT_EQ((pose_in_turns(legs, 1, kStarts[1], 0.5).inverse() * kStarts[1]).log().norm(), 0);
}

TEST(TurnDrives, MoreTurnsLeaveTheFirstAsTheyAre) {
  TurnDriveParams fewer;
  fewer.turns_per_robot = 2;
  const auto few = draw_turns(kStarts, to_walls_m, fewer, Rng(7)),
             all = draw_turns(kStarts, to_walls_m, {}, Rng(7));
  const auto other = draw_turns(kStarts, to_walls_m, {}, Rng(8));
  ASSERT_EQ(few.size(), 6U);
  for (std::size_t k = 0; k < few.size(); ++k) EXPECT_EQ(few[k].end_s, all[k].end_s);
  EXPECT_NE(few[5].end_s, other[5].end_s);
}

TEST(DriveLeg, TurnsOnTheSpotThenDrivesItsArcs) {
  DriveLeg leg;
  leg.T_common_begin = SE2({1, 1}, 0);
  leg.turn_rad = std::acos(-1.0) / 2;
  leg.arcs = {{{2, 0}, {std::acos(-1.0) / 2, 1}}};  // ahead, then a quarter circle of radius 1 to the left
  leg.begin_s = 10;
  leg.end_s = 20;
  const SE2 end = leg.pose_at(25);
  EXPECT_NEAR(end.translation().x(), 0, 1e-12);
  EXPECT_NEAR(end.translation().y(), 4, 1e-12);
  EXPECT_NEAR(std::abs(end.angle()), std::acos(-1.0), 1e-12);
  EXPECT_EQ(leg.pose_at(9).translation(), Eigen::Vector2d(1, 1));
  EXPECT_LT((leg.pose_at(15).translation() - leg.pose_after(leg.effort_m() / 2).translation()).norm(), 1e-12);
}

}  // namespace
}  // namespace radioslam
