#include "radioslam/graph/distributed/turns.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace radioslam {
namespace {

std::map<RobotNumber, RobotLinks> team(
    const std::vector<std::pair<RobotNumber, std::vector<RobotNumber>>>& links) {
  std::map<RobotNumber, RobotLinks> known;
  for (const auto& [robot, neighbours] : links) known[robot] = {robot, 0, neighbours};
  return known;
}

TEST(TurnOrder, NeighboursNeverMoveInTheSameRound) {
  const auto line_with_triangle = team({{2, {5}}, {5, {2, 7, 9}}, {7, {5, 9}}, {9, {5, 7, 11}}, {11, {9}}});
  const TurnOrder turns(line_with_triangle);
  EXPECT_EQ(turns.colours(), 3u);
  EXPECT_EQ(turns.diameter(), 3u);
  for (const auto& [robot, links] : line_with_triangle)
    for (const RobotNumber n : links.neighbours) EXPECT_NE(turns.colour(robot), turns.colour(n));
}

TEST(TurnOrder, EverybodyMovesOnceInAsManyRoundsAsThereAreColours) {
  const auto star = team({{0, {1, 2, 3}}, {1, {0}}, {2, {0}}, {3, {0}}});
  const TurnOrder turns(star);
  EXPECT_EQ(turns.colours(), 2u);
  for (const auto& [robot, links] : star) EXPECT_NE(turns.moves(robot, 4), turns.moves(robot, 5));
}

TEST(TurnOrder, ARobotAloneAlwaysMoves) {
  const TurnOrder turns(team({{3, {}}}));
  EXPECT_EQ(turns.diameter(), 0u);
  EXPECT_TRUE(turns.moves(3, 0));
  EXPECT_TRUE(turns.moves(3, 1));
}

}  // namespace
}  // namespace radioslam
