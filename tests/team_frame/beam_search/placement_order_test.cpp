#include "radioslam/team_frame/beam_search/placement_order.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

RangeEnd<SE2> end_at_pose(std::size_t pose) { return {PoseId(pose), {}, Eigen::Vector2d::Zero()}; }
RangeEnd<SE2> end_at_point(std::size_t point) { return {{}, PointId(point), Eigen::Vector2d::Zero()}; }

/// Three segments of two poses each (0 1, 2 3, 4 5) and one point; `counts` ranges between the given ends.
TeamGraph<SE2> ranged_team(const std::vector<std::tuple<std::size_t, RangeEnd<SE2>, int>>& counts) {
  TeamGraph<SE2> team;
  for (std::size_t p = 0; p < 3; ++p) team.segments.push_back({"r" + std::to_string(p), 2 * p, 2, {}});
  team.graph.poses.resize(6);
  team.graph.points.assign(1, Eigen::Vector2d::Zero());
  for (const auto& [i, j, count] : counts)
    for (int k = 0; k < count; ++k) team.graph.ranges.push_back({end_at_pose(i), j, 1, 1, {}, 1});
  return team;
}

const TeamComponents kNonePlaced{{kUnplaced, kUnplaced, kUnplaced}, {kUnplaced}};
const TeamComponents kFirstPlaced{{0, kUnplaced, kUnplaced}, {kUnplaced}};

TEST(PlacementOrder, ListsSegmentsBeforePoints) {
  const auto nodes = unplaced_nodes(ranged_team({}), kFirstPlaced);
  ASSERT_EQ(nodes.size(), 3u);
  EXPECT_TRUE(nodes[0].is_segment && nodes[1].is_segment);
  EXPECT_EQ(nodes[0].index, 1u);
  EXPECT_FALSE(nodes[2].is_segment);
}

TEST(PlacementOrder, BeginsWhereMostLinksAre) {
  EXPECT_EQ(next_root(ranged_team({{0, end_at_pose(2), 3}, {2, end_at_pose(5), 4}}), kNonePlaced), 1u);
  EXPECT_EQ(next_root(ranged_team({{0, end_at_pose(2), 2}}), kNonePlaced), std::nullopt);
}

TEST(PlacementOrder, TakesTheSegmentWithMostLinksNext) {
  const auto team = ranged_team({{0, end_at_pose(2), 3}, {1, end_at_pose(4), 5}, {0, end_at_point(0), 9}});
  const auto next = next_unit(team, kFirstPlaced, 0);
  ASSERT_TRUE(next.has_value());
  EXPECT_TRUE(next->is_segment);
  EXPECT_EQ(next->index, 2u);
}

TEST(PlacementOrder, TwoLinksPlaceASegmentWhoseHeadingIsKnown) {
  auto team = ranged_team({{0, end_at_pose(2), 2}});
  team.segments[1].sigma_heading_rad = 0.05;
  EXPECT_EQ(next_root(team, kNonePlaced), std::nullopt) << "the other one's is not";
  EXPECT_FALSE(next_unit(team, kFirstPlaced, 0).has_value());
  team.segments[0].sigma_heading_rad = 0.05;
  EXPECT_EQ(next_root(team, kNonePlaced), 0u);
  const auto next = next_unit(team, kFirstPlaced, 0);
  ASSERT_TRUE(next.has_value());
  EXPECT_EQ(next->index, 1u);
}

TEST(PlacementOrder, TakesAPointWhereNoSegmentHasEnoughLinks) {
  const auto next =
      next_unit(ranged_team({{0, end_at_pose(2), 2}, {0, end_at_point(0), 2}}), kFirstPlaced, 0);
  ASSERT_TRUE(next.has_value());
  EXPECT_FALSE(next->is_segment);
  EXPECT_FALSE(next_unit(ranged_team({{0, end_at_point(0), 1}}), kFirstPlaced, 0).has_value());
}

TEST(PlacementOrder, NumbersComponentsByTheirFirstSegments) {
  TeamComponents components{{4, 1, 4}, {1, kUnplaced, 4}};
  renumber(components);
  EXPECT_EQ(components.of_segment, (std::vector<int>{0, 1, 0}));
  EXPECT_EQ(components.of_point, (std::vector<int>{1, kUnplaced, 0}));
}

}  // namespace
}  // namespace radioslam
