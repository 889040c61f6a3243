#include "radioslam/team_frame/alignment_continuity.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "team_frame/radio_worlds.hpp"

namespace radioslam {
namespace {

test::RadioWorld world() {
  test::RadioWorld world;
  world.route_m = 400;
  return world;
}

/// Two robots, the second one turned about the first pose of all.
std::vector<SE2> turned(std::vector<SE2> poses, const TrajectorySegment& segment, double rad) {
  move_segment(poses, segment, SE2(Eigen::Vector2d::Zero(), rad));
  return poses;
}

class AlignmentContinuity : public testing::Test {
 protected:
  AlignmentContinuity()
      : simulated(test::RadioWorldSimulator(world(), 1).run()),
        components{std::vector<int>(2, 0), std::vector<int>(simulated.team.graph.points.size(), -1)},
        right(refine_alignments(simulated.team, components, {simulated.truth}, {})),
        wrong(at(turned(simulated.truth, simulated.team.segments[1], 2))) {}

  /// As if these poses were an alignment, with the evidence that they have.
  RadioAlignment<SE2> at(const std::vector<SE2>& poses) const {
    TeamGraph<SE2> team = simulated.team;
    team.graph.poses = poses;
    return {components, {weigh_links(team, components, {})}};
  }

  test::SimulatedTeam simulated;
  TeamComponents components;
  RadioAlignment<SE2> right, wrong;
};

TEST_F(AlignmentContinuity, AlignmentsAgreeWhateverTheFrame) {
  std::vector<SE2> moved = simulated.truth;
  for (SE2& pose : moved) pose = SE2({30, -20}, 1) * pose;
  const auto& segments = simulated.team.segments;
  EXPECT_TRUE(agree(simulated.truth, moved, segments, {0, 0}));
  const auto other = turned(simulated.truth, segments[1], 2);
  EXPECT_FALSE(agree(simulated.truth, other, segments, {0, 0}));
  EXPECT_TRUE(agree(simulated.truth, other, segments, {0, 1})) << "in frames of their own";
}

TEST_F(AlignmentContinuity, AClearlyLikelierAlignmentReplacesTheOneBefore) {
  const auto now = continued(simulated.team, right, wrong, {});
  EXPECT_TRUE(
      agree(now.hypotheses.front().poses, right.hypotheses.front().poses, simulated.team.segments, {0, 0}));
}

TEST_F(AlignmentContinuity, ALessLikelyOneDoesNot) {
  const auto now = continued(simulated.team, wrong, right, {});
  EXPECT_TRUE(
      agree(now.hypotheses.front().poses, right.hypotheses.front().poses, simulated.team.segments, {0, 0}));
}

/// One that nothing else agrees with is as certain as measurements make it, whatever it was before.
TEST_F(AlignmentContinuity, OneThatStaysIsNotCertainForThat) {
  RadioAlignmentParams undecided;
  undecided.beam.evidence_temperature = 1e9;
  const auto now = continued(simulated.team, wrong, right, undecided);
  ASSERT_EQ(now.hypotheses.size(), 2U);
  EXPECT_TRUE(
      agree(now.hypotheses.front().poses, right.hypotheses.front().poses, simulated.team.segments, {0, 0}));
  EXPECT_NEAR(now.hypotheses[0].weight, 0.5, 1e-3);
  EXPECT_NEAR(now.hypotheses[1].weight, 0.5, 1e-3);
  EXPECT_NEAR(continued(simulated.team, wrong, right, {}).hypotheses.front().weight, 1, 1e-6);
}

/// Of those found, the one before comes first unless another one is clearly likelier.
TEST_F(AlignmentContinuity, TheOneBeforeStaysAmongOthers) {
  RadioAlignment<SE2> both = right;
  both.hypotheses.insert(both.hypotheses.begin(), wrong.hypotheses.front());
  const auto now = continued(simulated.team, both, right, {});
  ASSERT_EQ(now.hypotheses.size(), both.hypotheses.size());
  EXPECT_TRUE(
      agree(now.hypotheses.front().poses, right.hypotheses.front().poses, simulated.team.segments, {0, 0}));
}

}  // namespace
}  // namespace radioslam
