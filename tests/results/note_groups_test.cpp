#include "radioslam/results/note_groups.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

using Texts = std::vector<std::string>;

TEST(NoteGroups, NotesThatDifferInRobotsAndNumbersAreOfOneKind) {
  const Texts notes{"robot a: 3 of 10 position fixes contradict the estimate", "the map ends at 5 m",
                    "robot b-2: 12 of 40 position fixes contradict the estimate",
                    "robots/a/odometry.tum: no pose for 3.5 s", "robots/b-2/odometry.tum: no pose for 12 s"};
  const auto groups = grouped_notes(notes, {"a", "b", "b-2"});
  ASSERT_EQ(groups.size(), 3U);
  EXPECT_EQ(groups[0].notes, (Texts{notes[0], notes[2]}));
  EXPECT_EQ(groups[0].robots, (Texts{"a", "b-2"}));
  EXPECT_EQ(groups[1].notes, Texts{notes[1]});
  EXPECT_EQ(groups[2].notes, (Texts{notes[3], notes[4]}));
}

TEST(NoteGroups, DigitsOfANameAreNoNumber) {
  EXPECT_EQ(grouped_notes({"graph.g2o has no loops", "graph.g3o has no loops"}, {}).size(), 2U);
}

TEST(NoteGroups, ANameThatIsAWordOfAllNotesIsNotTheOneTheyAreAbout) {
  const auto groups =
      grouped_notes({"a start of robot b is wrong", "a start of robot c is wrong"}, {"a", "b", "c"});
  ASSERT_EQ(groups.size(), 1U);
  EXPECT_EQ(groups[0].robots, (Texts{"b", "c"}));
}

TEST(NoteGroups, ALineCountsItsNotesAndNamesTheRobots) {
  EXPECT_EQ(line_of(grouped_notes({"robot a is late"}, {"a"}).front()), "robot a is late");
  Texts notes, robots;
  for (int k = 0; k < 65; ++k) {
    robots.push_back("r" + std::to_string(k));
    notes.push_back("robot " + robots.back() + " is not placed");
  }
  const auto groups = grouped_notes(notes, robots);
  ASSERT_EQ(groups.size(), 1U);
  EXPECT_EQ(line_of(groups[0]),
            "robot r0 is not placed (65 notes of this kind: r0, r1, r2, r3, r4, r5, r6, r7, ...; "
            "summary.json has all)");
}

}  // namespace
}  // namespace radioslam
