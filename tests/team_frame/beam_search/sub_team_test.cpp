#include <gtest/gtest.h>

#include "radioslam/team_frame/beam_search/local_placement.hpp"
#include "team_frame/radio_worlds.hpp"

namespace radioslam {
namespace {

/// Three robots; between every two of them as many ranges as links.
test::SimulatedTeam three_robots() {
  test::RadioWorld world;
  world.robots = 3;
  world.route_m = 300;
  world.blocks = 3;
  world.links = 10;
  return test::simulate_team(world, 4);
}

TEST(SubTeam, HasTheSegmentsAndEverythingWithinAndBetweenThem) {
  const TeamGraph<SE2> whole = three_robots().team;
  const SubTeam<SE2> part = sub_team(whole, {0, 2});
  ASSERT_EQ(part.team.segments.size(), 2U);
  EXPECT_EQ(part.segments, (std::vector<std::size_t>{0, 2}));
  const std::size_t poses = whole.segments[0].pose_count + whole.segments[2].pose_count;
  EXPECT_EQ(part.team.graph.poses.size(), poses);
  EXPECT_EQ(part.team.graph.relative_poses.size(), poses - 2);
  EXPECT_EQ(part.team.graph.ranges.size(), whole.graph.ranges.size() / 3);
  EXPECT_EQ(part.team.bearings.size(), whole.bearings.size() / 3);
  EXPECT_EQ(part.team.segments[1].robot, whole.segments[2].robot);
}

TEST(SubTeam, KeepsEveryFactorsMeasurementAndEnds) {
  const TeamGraph<SE2> whole = three_robots().team;
  const SubTeam<SE2> part = sub_team(whole, {1, 2});
  const std::size_t dropped = whole.segments[0].pose_count;
  std::vector<RangeFactor<SE2>> expected;
  for (const auto& range : whole.graph.ranges)
    if (range.i.pose.index() >= dropped && range.j.pose.index() >= dropped) expected.push_back(range);
  ASSERT_EQ(part.team.graph.ranges.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_EQ(part.team.graph.ranges[k].range_m, expected[k].range_m);
    EXPECT_EQ(part.team.graph.ranges[k].i.pose.index() + dropped, expected[k].i.pose.index());
    EXPECT_EQ(part.team.graph.ranges[k].j.pose.index() + dropped, expected[k].j.pose.index());
  }
}

TEST(SubTeam, OfAllSegmentsIsTheTeam) {
  const TeamGraph<SE2> whole = three_robots().team;
  const SubTeam<SE2> part = sub_team(whole, {0, 1, 2});
  EXPECT_EQ(part.team.graph.poses.size(), whole.graph.poses.size());
  EXPECT_EQ(part.team.graph.relative_poses.size(), whole.graph.relative_poses.size());
  EXPECT_EQ(part.team.bearings.size(), whole.bearings.size());
}

}  // namespace
}  // namespace radioslam
