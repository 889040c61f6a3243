#include <gtest/gtest.h>

#include <map>

#include "radioslam/team_frame/odometry_compression.hpp"

namespace radioslam {
namespace {

/// `robots` robots of a hundred poses each, every pair with a hundred ranges and angles at both ends.
TeamGraph<SE2> dense_team(std::size_t robots) {
  constexpr std::size_t kPoses = 100;
  TeamGraph<SE2> team;
  for (std::size_t r = 0; r < robots; ++r) {
    TrajectorySegment segment;
    segment.first_pose = team.graph.poses.size();
    segment.pose_count = kPoses;
    for (std::size_t k = 0; k < kPoses; ++k)
      segment.stamps.push_back(Stamp::from_seconds(static_cast<double>(k)));
    team.segments.push_back(segment);
    team.graph.poses.resize(team.graph.poses.size() + kPoses);
  }
  for (std::size_t a = 0; a < robots; ++a)
    for (std::size_t b = a + 1; b < robots; ++b)
      for (std::size_t k = 0; k < kPoses; ++k) {
        const PoseId i(a * kPoses + k), j(b * kPoses + k);
        team.graph.ranges.push_back({{i, {}, {}}, {j, {}, {}}, 1, 0.5});
        AmbiguousBearing<SE2> bearing;
        bearing.i = i;
        bearing.j.pose = j;
        team.bearings.push_back(bearing);
        bearing.i = j;
        bearing.j.pose = i;
        team.bearings.push_back(bearing);
      }
  return team;
}

/// Ranges of the pair (0, 1), and all of robot 0.
std::pair<std::size_t, std::size_t> kept_ranges(std::size_t robots, const GridParams& params) {
  std::size_t of_pair = 0, of_robot = 0;
  for (const auto& range : thin_links(dense_team(robots), params).graph.ranges) {
    const std::size_t a = range.i.pose.index() / 100, b = range.j.pose.index() / 100;
    of_pair += a == 0 && b == 1;
    of_robot += a == 0 || b == 0;
  }
  return {of_pair, of_robot};
}

TEST(ThinLinks, APairKeepsAtMostItsLimit) {
  EXPECT_EQ(kept_ranges(2, {}).first, 80U);
  GridParams few;
  few.max_links = 7;
  EXPECT_EQ(kept_ranges(3, few).first, 7U);
}

TEST(ThinLinks, LinksOfARobotOfALargeTeamDoNotGrowWithTheTeam) {
  EXPECT_EQ(kept_ranges(4, {}).second, 240U);
  EXPECT_EQ(kept_ranges(11, {}).second, 240U);
  EXPECT_EQ(kept_ranges(11, {}).first, 24U);
  EXPECT_EQ(kept_ranges(40, {}).first, 8U) << "a pair keeps enough to place one robot by the other";
}

TEST(ThinLinks, AnchorsAreNoPartners) {
  TeamGraph<SE2> team = dense_team(2);
  for (std::size_t anchor = 0; anchor < 28; ++anchor) {
    team.graph.points.emplace_back();
    team.graph.ranges.push_back({{PoseId(anchor), {}, {}}, {{}, PointId(anchor), {}}, 1, 0.5});
  }
  EXPECT_EQ(thin_links(team, {}).graph.ranges.size(), 80U + 28U);
}

TEST(ThinLinks, RangesAndAnglesHaveThePartnersOfEither) {
  TeamGraph<SE2> team = dense_team(11);
  std::erase_if(team.bearings, [](const auto& b) { return b.i.index() >= 200 || b.j.pose.index() >= 200; });
  std::size_t angles = 0;
  for (const auto& bearing : thin_links(team, {}).bearings) angles += bearing.i.index() < 100;
  EXPECT_EQ(angles, 24U) << "as many as ranges of the same two robots";
}

TEST(ThinLinks, AnglesStayWithTheirRangesAndAreSpread) {
  const TeamGraph<SE2> thinned = thin_links(dense_team(11), {});
  std::map<std::size_t, int> angles_at;
  std::size_t first = 1000, last = 0;
  for (const auto& range : thinned.graph.ranges) {
    if (range.i.pose.index() >= 100 || range.j.pose.index() / 100 != 1) continue;
    first = std::min(first, range.i.pose.index());
    last = std::max(last, range.i.pose.index());
    angles_at[range.i.pose.index()] = 0;
  }
  EXPECT_LT(first, 5U);
  EXPECT_GT(last, 94U);
  for (const auto& bearing : thinned.bearings)
    if (bearing.i.index() < 100 && bearing.j.pose.index() / 100 == 1) ++angles_at[bearing.i.index()];
  for (const auto& [pose, angles] : angles_at) EXPECT_EQ(angles, 1) << pose;
}

}  // namespace
}  // namespace radioslam
