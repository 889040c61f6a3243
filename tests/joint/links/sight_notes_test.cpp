// Which robots are said to rest on detours.
#include "radioslam/joint/links/sight_notes.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

ClosureResult closure(std::size_t i, std::size_t j, ClosureKind kind, ClosureStatus status) {
  ClosureResult result;
  result.robot_i = RobotIndex(i);
  result.robot_j = RobotIndex(j);
  result.kind = kind;
  result.status = status;
  return result;
}

std::vector<RobotResult> robots() {
  std::vector<RobotResult> result(2);
  result[0].id = "a";
  result[0].start_known = true;
  result[1].id = "b";
  return result;
}

/// Ten ranges between the two robots.
std::vector<ClosureResult> ranges(std::size_t accepted) {
  std::vector<ClosureResult> result;
  for (std::size_t k = 0; k < 10; ++k)
    result.push_back(closure(0, 1, ClosureKind::kRange,
                             k < accepted ? ClosureStatus::kAccepted : ClosureStatus::kRejected));
  return result;
}

TEST(SightNotes, NameRobotsWithoutLinksInSight) {
  const auto notes = notes_on_obstructed_robots(robots(), ranges(2));
  ASSERT_EQ(notes.size(), 1U) << "the start of a is known";
  EXPECT_EQ(
      notes[0],
      "the place of robot b is uncertain: 2 of its 10 ranges and angles to other robots agree with it, the "
      "others are detours or false");
  EXPECT_TRUE(notes_on_obstructed_robots(robots(), ranges(3)).empty());
  EXPECT_TRUE(notes_on_obstructed_robots(robots(), {}).empty());
}

TEST(SightNotes, OtherClosuresFixARobotToo) {
  auto closures = ranges(0);
  closures.push_back(closure(1, 0, ClosureKind::kMatch, ClosureStatus::kRejected));
  EXPECT_EQ(notes_on_obstructed_robots(robots(), closures).size(), 1U);
  closures.push_back(closure(1, 0, ClosureKind::kMatch, ClosureStatus::kAccepted));
  EXPECT_TRUE(notes_on_obstructed_robots(robots(), closures).empty());
}

TEST(SightNotes, LoopClosuresOfOneRobotDoNot) {
  auto closures = ranges(0);
  closures.push_back(closure(1, 1, ClosureKind::kLidar, ClosureStatus::kAccepted));
  EXPECT_EQ(notes_on_obstructed_robots(robots(), closures).size(), 1U);
}

}  // namespace
}  // namespace radioslam
