// Selection of measurements while only part of a team shares a frame.
#include "radioslam/team_frame/connected_measurements.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

constexpr int kAlone = -1;

RangeEnd<SE2> at_pose(std::size_t pose) { return {PoseId(pose), {}, Eigen::Vector2d::Zero()}; }
RangeEnd<SE2> at_point(std::size_t point) { return {{}, PointId(point), Eigen::Vector2d::Zero()}; }

/// Three segments of two poses each (0 1, 2 3, 4 5) and three points; `ends` become ranges, bearings and
/// sightings.
TeamGraph<SE2> make_team(const std::vector<std::pair<std::size_t, RangeEnd<SE2>>>& ends) {
  TeamGraph<SE2> team;
  for (std::size_t p = 0; p < 3; ++p) {
    team.segments.push_back({"r" + std::to_string(p), 2 * p, 2, {}});
    team.graph.relative_poses.push_back({PoseId(2 * p), PoseId(2 * p + 1), SE2({1, 0}, 0)});
  }
  team.graph.poses.resize(6);
  team.graph.points.assign(3, Eigen::Vector2d::Zero());
  for (const auto& [i, j] : ends) {
    const auto number = static_cast<double>(team.graph.ranges.size());
    team.graph.ranges.push_back({at_pose(i), j, number, 1, {}, 1});
    team.bearings.push_back({PoseId(i), j, {{Eigen::Vector2d::UnitX(), 1, number}}});
    team.graph.relative_points.push_back({PoseId(i), j, Eigen::Vector2d(number, 0)});
  }
  return team;
}

/// The first two segments share a frame with the first point; the second point is in a frame of its own.
const TeamComponents kComponents{{0, 0, kAlone}, {0, 1, kAlone}};

TEST(SegmentOfPoses, FollowsTheSegments) {
  EXPECT_EQ(segment_of_poses(make_team({})), (std::vector<std::size_t>{0, 0, 1, 1, 2, 2}));
}

TEST(ConnectedTeam, KeepsWhatTiesEndsOfOneFrame) {
  const auto team = make_team({{0, at_pose(3)},    // two segments of one component
                               {0, at_pose(4)},    // one of them unplaced
                               {4, at_pose(5)},    // unplaced, but within one segment
                               {5, at_point(2)},   // both unplaced
                               {2, at_point(0)},   // a point of the component
                               {2, at_point(1)},   // a point of another one
                               {3, at_pose(1)}});  // ends swapped
  const auto connected = connected_team(team, kComponents);
  const std::vector<std::size_t> expected{0, 2, 4, 6};
  EXPECT_EQ(connected.ranges, expected);
  EXPECT_EQ(connected.bearings, expected);
  ASSERT_EQ(connected.team.graph.ranges.size(), expected.size());
  ASSERT_EQ(connected.team.bearings.size(), expected.size());
  ASSERT_EQ(connected.team.graph.relative_points.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const auto number = static_cast<double>(expected[k]);
    EXPECT_EQ(connected.team.graph.ranges[k].range_m, number);
    EXPECT_EQ(connected.team.bearings[k].paths[0].power_db, number);
    EXPECT_EQ(connected.team.graph.relative_points[k].position.x(), number);
  }
}

TEST(ConnectedTeam, KeepsOdometryAndDropsRelativePosesAcrossFrames) {
  auto team = make_team({});
  team.graph.relative_poses.push_back({PoseId(0), PoseId(2), SE2({5, 0}, 0)});
  team.graph.relative_poses.push_back({PoseId(2), PoseId(4), SE2({6, 0}, 0)});
  const auto& factors = connected_team(team, kComponents).team.graph.relative_poses;
  ASSERT_EQ(factors.size(), 4U);
  EXPECT_EQ(factors[3].T_i_j.translation().x(), 5);
}

TEST(ConnectedTeam, LeavesValuesAndOtherFactorsAsTheyAre) {
  auto team = make_team({});
  team.graph.poses[4] = SE2({3, 4}, 0.5);
  team.graph.points[1] = {7, 8};
  team.graph.positions.push_back({at_point(2), Eigen::Vector2d(1, 2)});
  team.graph.pose_priors.push_back({PoseId(4), SE2({3, 4}, 0.5)});
  const auto& graph = connected_team(team, kComponents).team.graph;
  EXPECT_EQ(graph.poses[4].translation(), Eigen::Vector2d(3, 4));
  EXPECT_EQ(graph.points[1], Eigen::Vector2d(7, 8));
  EXPECT_EQ(graph.positions.size(), 1U);
  EXPECT_EQ(graph.pose_priors.size(), 1U);
}

}  // namespace
}  // namespace radioslam
