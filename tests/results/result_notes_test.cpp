// Notes are true of the result: what it refutes is not said, what it rejects is.
#include "radioslam/results/result_notes.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

RunResult two_robots(bool in_one_frame) {
  RunResult result;
  result.robots.resize(2);
  result.robots[0].id = "a";
  result.robots[1].id = "b";
  result.components =
      in_one_frame ? std::vector<Component>{{{"a", "b"}}} : std::vector<Component>{{{"a"}}, {{"b"}}};
  return result;
}

void add_closures(RunResult& result, ClosureKind kind, ClosureStatus status, std::size_t count,
                  const std::string& reason = "") {
  ClosureResult closure;
  closure.robot_i = RobotIndex(0);
  closure.robot_j = RobotIndex(1);
  closure.kind = kind;
  closure.status = status;
  closure.reason = reason;
  result.closures.insert(result.closures.end(), count, closure);
}

const Finding kNotConnected{"not-connected", Severity::kWarning, "b", "", "nothing ties robot 'b'", "", ""};
const Finding kNoFit{"frame", Severity::kWarning, "", "", "the radio links do not fit", "", ""};
const Finding kGap{"gap", Severity::kWarning, "b", "robots/b/odometry.tum", "no pose for 9 s", "", ""};

TEST(ResultNotes, ARobotThatScansJoinedHasNoFrameOfItsOwn) {
  EXPECT_TRUE(finding_notes({kNotConnected}, two_robots(true)).empty());
  EXPECT_TRUE(component_notes(two_robots(true)).empty());
  const auto notes = component_notes(two_robots(false));
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes[0].find("robot b has a frame of its own"), 0U) << notes[0];
}

TEST(ResultNotes, AnUnplacedRobotIsNotNotedTwice) {
  RunResult result = two_robots(false);
  result.unplaced = {"b"};
  EXPECT_TRUE(component_notes(result).empty());
}

TEST(ResultNotes, LinksThatWereAcceptedDoFit) {
  RunResult result = two_robots(true);
  result.robots[1].fixes.emplace();
  result.robots[1].fixes->used = 30;
  EXPECT_EQ(finding_notes({kNoFit, kGap}, result).size(), 1U);
  add_closures(result, ClosureKind::kRange, ClosureStatus::kRejected, 31);
  EXPECT_EQ(finding_notes({kNoFit, kGap}, result).size(), 2U);
}

TEST(ResultNotes, ThatAllMatchesWereRejectedIsNoted) {
  RunResult result = two_robots(true);
  add_closures(result, ClosureKind::kMatch, ClosureStatus::kRejected, 60, "no group stands out");
  add_closures(result, ClosureKind::kMatch, ClosureStatus::kRejected, 100, "the joint estimate disagrees");
  const auto notes = rejection_notes(result.closures);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes[0].find("all 160 matches were rejected"), 0U) << notes[0];
  EXPECT_NE(notes[0].find("most often: the joint estimate disagrees"), std::string::npos) << notes[0];
  add_closures(result, ClosureKind::kMatch, ClosureStatus::kAccepted, 1);
  EXPECT_TRUE(rejection_notes(result.closures).empty());
}

TEST(ResultNotes, AFewRangesMayAllBeObstructed) {
  RunResult result = two_robots(true);
  add_closures(result, ClosureKind::kRange, ClosureStatus::kRejected, 5);
  add_closures(result, ClosureKind::kLidar, ClosureStatus::kRejected, 500);
  EXPECT_TRUE(rejection_notes(result.closures).empty());
  add_closures(result, ClosureKind::kRange, ClosureStatus::kRejected, 1);
  EXPECT_EQ(rejection_notes(result.closures).size(), 1U);
}

TEST(ResultNotes, LookAlikesThatAloneTieRobotsAreNoted) {
  RunResult result = two_robots(true);
  add_closures(result, ClosureKind::kLidar, ClosureStatus::kAccepted, 12);
  add_closures(result, ClosureKind::kLidar, ClosureStatus::kRejected, 30, "elsewhere");
  const auto note = look_alike_note(result.closures, "elsewhere");
  ASSERT_TRUE(note);
  EXPECT_NE(note->find("30 of 42 compared places"), std::string::npos) << *note;
  auto with_ranges = result;
  add_closures(with_ranges, ClosureKind::kRange, ClosureStatus::kAccepted, 1);
  EXPECT_FALSE(look_alike_note(with_ranges.closures, "elsewhere"));
  add_closures(result, ClosureKind::kLidar, ClosureStatus::kRejected, 60, "the scans do not fit");
  EXPECT_FALSE(look_alike_note(result.closures, "elsewhere"));
}

}  // namespace
}  // namespace radioslam
