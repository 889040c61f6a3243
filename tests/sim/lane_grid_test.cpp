#include "radioslam/sim/worlds/lane_grid.hpp"

#include <gtest/gtest.h>

#include <set>

namespace radioslam {
namespace {

std::size_t reachable(const LaneGrid& lanes) {
  std::set<std::size_t> reached{0}, front{0};
  while (!front.empty()) {
    std::set<std::size_t> next;
    for (const std::size_t i : front)
      for (const std::size_t j : lanes.neighbours(i))
        if (reached.insert(j).second) next.insert(j);
    front = next;
  }
  return reached.size();
}

TEST(LaneGrid, HasAllLanesWhenNoneIsClosed) {
  LaneGridParams params;
  params.closed_lane_ratio = 0;
  const LaneGrid lanes(params, Rng(1));
  EXPECT_EQ(lanes.size(), 24U);
  EXPECT_EQ(lanes.lane_count(), 5U * 4 + 6 * 3);
  EXPECT_EQ(lanes.crossing(0), Eigen::Vector2d(5, 5));
  EXPECT_EQ(lanes.crossing(23), Eigen::Vector2d(80, 55));
}

TEST(LaneGrid, ClosesTheRequestedRatioAndStaysPassable) {
  const LaneGridParams params;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const LaneGrid lanes(params, Rng(seed));
    EXPECT_EQ(lanes.lane_count(), 38U - 5);  // 15 % of 38, rounded down
    EXPECT_EQ(reachable(lanes), lanes.size());
    for (std::size_t i = 0; i < lanes.size(); ++i) EXPECT_GE(lanes.neighbours(i).size(), 2U);
  }
}

TEST(LaneGrid, ClosesNoMoreThanItCan) {
  LaneGridParams params;
  params.aisles_along_x = params.aisles_along_y = 2;
  params.closed_lane_ratio = 0.5;
  EXPECT_EQ(LaneGrid(params, Rng(1)).lane_count(), 4U);  // a ring: every lane is needed
}

TEST(LaneGrid, MeasuresTheDistanceToTheNearestCentreLine) {
  LaneGridParams params;
  params.closed_lane_ratio = 0;
  const LaneGrid lanes(params, Rng(1));
  EXPECT_DOUBLE_EQ(lanes.distance_to_lane_m({5, 30}), 0);
  EXPECT_DOUBLE_EQ(lanes.distance_to_lane_m({0, 30}), 5);
  EXPECT_DOUBLE_EQ(lanes.distance_to_lane_m({12, 13}), 7);  // aisles at x = 5, 20 and y = 5, 21.7
  EXPECT_DOUBLE_EQ(lanes.distance_to_lane_m({2, 1}), 5);
}

}  // namespace
}  // namespace radioslam
