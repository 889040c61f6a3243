#include "radioslam/joint/closures/loop_stage.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "joint/closures/block_team.hpp"
#include "joint/closures/loop_team.hpp"
#include "radioslam/graph/residuals.hpp"
#include "radioslam/joint/closures/team_loops.hpp"

namespace radioslam {
namespace {

std::size_t accepted(const BlockTeam::Outcome& out, std::size_t begin, std::size_t end) {
  return static_cast<std::size_t>(
      std::count_if(out.judgements.begin() + static_cast<std::ptrdiff_t>(begin),
                    out.judgements.begin() + static_cast<std::ptrdiff_t>(end),
                    [](const ClosureJudgement& j) { return j.status == ClosureStatus::kAccepted; }));
}

const SE2 kElsewhere({20, -35}, 0.8);

TEST(CloseByLoops, AlignsTwoRobotsAndRejectsWhatContradicts) {
  BlockTeam team(2);
  for (std::size_t k = 40; k < 160; k += 20) team.see(0, k, 1, k - 40);
  for (std::size_t k = 0; k < 3; ++k) team.mistake(0, 20 + 7 * k, 1, 90 - k, kElsewhere);
  const auto out = team.solve();
  EXPECT_EQ(out.alignment.component, (std::vector<int>{0, 0}));
  EXPECT_TRUE(out.alignment.placed[1]);
  EXPECT_EQ(accepted(out, 0, 6), 6u);
  EXPECT_EQ(accepted(out, 6, 9), 0u);
  for (std::size_t k = 40; k < 160; k += 10) EXPECT_LT(team.relative_error_m(out, 0, k, 1, k - 40), 0.7);
}

TEST(CloseByLoops, CountsRepetitionsOfAMeasurementOnce) {
  BlockTeam once(2);
  for (std::size_t k = 40; k < 160; k += 20) once.see(0, k, 1, k - 40);
  BlockTeam often = once;
  often.repeat_last(219);
  const auto one = once.solve(), many = often.solve();
  for (std::size_t r = 0; r < 2; ++r)
    for (std::size_t k = 0; k < 200; ++k)
      EXPECT_LT((once.pose(one, r, k).inverse() * often.pose(many, r, k)).log().norm(), 1e-9);
  EXPECT_EQ(accepted(many, 0, many.closures.size()), many.closures.size());
}

TEST(CloseByLoops, RepetitionsAloneDoNotPlaceARobot) {
  BlockTeam team(2);
  team.see(0, 100, 1, 60);
  team.repeat_last(219);
  const auto out = team.solve();
  EXPECT_EQ(out.alignment.component, (std::vector<int>{0, 1}));
  EXPECT_FALSE(out.alignment.placed[1]);
  EXPECT_EQ(accepted(out, 0, out.closures.size()), 0u);
  EXPECT_EQ(out.judgements.front().reason, "no group of loops stands out");
}

TEST(CloseByLoops, CorrectsTrajectoriesByTheirOwnLoops) {
  BlockTeam apart(1, 320), looped(1, 320);
  for (std::size_t k = 0; k < 160; k += 16) looped.see(0, k, 0, k + BlockTeam::kRound);
  for (std::size_t k = 0; k < 4; ++k) looped.mistake(0, 10 + 9 * k, 0, 90 - k, kElsewhere);
  const auto out = looped.solve();
  EXPECT_EQ(accepted(out, 0, 10), 10u);
  EXPECT_EQ(accepted(out, 10, 14), 0u);
  EXPECT_LT(looped.largest_error_m(out, 0, 0), 0.6 * apart.largest_error_m(apart.solve(), 0, 0));
}

TEST(CloseByLoops, LoopsThatContradictEachOtherByLittleLeaveAlternatives) {
  // Two readings of the same round, 2 m apart, which the odometry cannot tell from one another.
  BlockTeam team(1, 320);
  for (std::size_t k = 60; k < 84; k += 6) team.see(0, k, 0, k + BlockTeam::kRound);
  for (std::size_t k = 63; k < 87; k += 6) team.mistake(0, k, 0, k + BlockTeam::kRound, SE2({0, 2}, 0));
  const auto out = team.solve();
  ASSERT_EQ(out.alignment.alternatives.size(), 1u);
  EXPECT_LT(out.alignment.weight, 0.9);
  EXPECT_NEAR(out.alignment.weight + out.alignment.alternative_weights.front(), 1, 1e-9);
  auto other = out;
  other.joint.team.graph.poses = out.alignment.alternatives.front();
  const double error_m = team.relative_error_m(out, 0, 80, 0, 240),
               other_m = team.relative_error_m(other, 0, 80, 0, 240);
  EXPECT_LT(std::min(error_m, other_m), 0.3);
  EXPECT_GT(std::max(error_m, other_m), 1);
}

TEST(CloseByLoops, AHandfulAgainstManyIsNoAlternative) {
  BlockTeam team(1, 320);
  for (std::size_t k = 0; k < 160; k += 4) team.see(0, k, 0, k + BlockTeam::kRound);
  for (std::size_t k = 63; k < 87; k += 6) team.mistake(0, k, 0, k + BlockTeam::kRound, SE2({0, 2}, 0));
  const auto out = team.solve();
  EXPECT_TRUE(out.alignment.alternatives.empty());
  EXPECT_EQ(out.alignment.weight, 1);
  EXPECT_LT(team.relative_error_m(out, 0, 80, 0, 240), 0.3);
}

TEST(CloseByLoops, LeavesRobotsApartWhereGroupsAreEquallyStrong) {
  BlockTeam team(2);
  for (const std::size_t k : {40u, 100u}) team.see(0, k, 1, k - 40);
  for (const std::size_t k : {60u, 130u}) team.mistake(0, k, 1, k - 40, kElsewhere);
  const auto out = team.solve();
  EXPECT_EQ(out.alignment.component, (std::vector<int>{0, 1}));
  EXPECT_EQ(accepted(out, 0, 4), 0u);
}

TEST(CloseByLoops, WithUnitWeightsTheLargestSetJoinsRobotsHoweverWeak) {
  BlockTeam team(2);
  for (const std::size_t k : {40u, 100u}) team.see(0, k, 1, k - 40);
  for (const std::size_t k : {60u, 130u}) team.mistake(0, k, 1, k - 40, kElsewhere);
  const auto few = team.solve({"identity", 100, 5});
  EXPECT_EQ(few.alignment.component, (std::vector<int>{0, 1}));
  EXPECT_EQ(few.judgements.front().reason, "no group of loops stands out");
  EXPECT_EQ(team.solve({"identity", 100, 4}).alignment.component, (std::vector<int>{0, 0}));
  EXPECT_EQ(team.solve({"identity", 1e-6, 4}).alignment.component, (std::vector<int>{0, 1}));
}

TEST(CloseByLoops, ACycleOfThreeRobotsDecidesBetweenGroups) {
  BlockTeam team(3);
  for (const std::size_t k : {45u, 100u}) team.see(0, k, 1, k - 40);
  for (const std::size_t k : {60u, 90u, 130u}) team.mistake(0, k, 1, k - 40, kElsewhere);
  for (const std::size_t k : {85u, 120u, 160u}) team.see(0, k, 2, k - 80);
  for (const std::size_t k : {50u, 90u, 140u}) team.see(1, k, 2, k - 40);
  const auto out = team.solve();
  EXPECT_EQ(out.alignment.component, (std::vector<int>{0, 0, 0}));
  EXPECT_EQ(accepted(out, 0, 2), 2u);
  EXPECT_EQ(accepted(out, 2, 5), 0u);
  EXPECT_EQ(accepted(out, 5, 11), 6u);
  for (const std::size_t k : {45u, 100u}) EXPECT_LT(team.relative_error_m(out, 0, k, 1, k - 40), 0.7);
}

TEST(CloseByLoops, KeepsTrueLoopsWhoseCovariancesAreTooSmallAndSaysSo) {
  BlockTeam team(2);
  for (std::size_t k = 40; k < 199; k += 3) team.see(0, k, 1, k - 40, 3);
  const auto out = team.solve();
  EXPECT_EQ(out.alignment.component, (std::vector<int>{0, 0}));
  EXPECT_GE(accepted(out, 0, out.closures.size()), out.closures.size() * 95 / 100);
  const auto& notes = out.alignment.notes;
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
    return note.starts_with("the errors of loop closures are 3.") ||
           note.starts_with("the errors of loop closures are 2.");
  }));
}

/// The truncated cost of a team at stated covariances, solved from poses with the loops that hold there.
class TruncatedCost {
 public:
  TruncatedCost(const LoopTeam& team, const JointGraph<SE2>& joint, const std::vector<Closure>& closures)
      : team_(team),
        gates_(team.loops.size()),
        first_(team.team.graph.relative_poses.size() - team.loops.size()) {
    for (const TeamLoop<SE2>& loop : team_loops(joint, closures))
      for (const std::size_t k : loop.closures) gates_[k] = loop.gate;
  }

  double from(const std::vector<SE2>& poses, std::vector<bool> holds = {}) const {
    PoseGraph<SE2> graph = team_.team.graph;
    graph.poses = poses;
    if (holds.empty()) holds = held(graph);
    for (int round = 0; round < 30; ++round) {
      for (std::size_t k = 0; k < holds.size(); ++k)
        graph.relative_poses[first_ + k].weight = holds[k] ? 1 : 0;
      optimize(graph, {});
      if (held(graph) == holds) break;
      holds = held(graph);
    }
    double cost = 0;
    for (std::size_t k = 0; k < first_; ++k) cost += squared_norm(graph, graph.relative_poses[k]);
    for (std::size_t k = 0; k < gates_.size(); ++k)
      cost += std::min(gates_[k], squared_norm(graph, team_.loops[k]));
    return cost;
  }

 private:
  std::vector<bool> held(const PoseGraph<SE2>& graph) const {
    std::vector<bool> holds;
    for (std::size_t k = 0; k < gates_.size(); ++k)
      holds.push_back(squared_norm(graph, team_.loops[k]) <= gates_[k]);
    return holds;
  }

  const LoopTeam& team_;
  std::vector<double> gates_;
  std::size_t first_;
};

/// Cost of the estimate over that of the solution started from the truth.
double cost_over_truth(std::uint64_t seed) {
  const LoopTeam team(seed);
  JointGraph<SE2> joint = joint_graph_of(team.team, team.mission);
  const std::vector<Closure> closures = closures_of(team.team, joint);
  const TruncatedCost cost(team, joint, closures);
  TeamAlignment<SE2> alignment;
  for (int r = 0; r < 3; ++r) alignment.component.push_back(r);
  alignment.placed = {true, false, false};
  alignment.absolute.assign(3, false);
  alignment.in_common_frame.assign(3, false);
  alignment.without_matches = alignment.of_segment = alignment.component;
  std::vector<ClosureJudgement> judgements(closures.size());
  add_own_loops(joint, closures, {});
  close_by_loops(joint, alignment, closures, judgements, {}, {}, {});
  return cost.from(joint.team.graph.poses) / cost.from(team.truth, team.is_true);
}

TEST(CloseByLoops, LeavesValleysThatFalseGroupsBendTheOdometryInto) {
  // Without trials of other solutions 3.9 and 1.7 times the cost of the right one.
  for (const std::uint64_t seed : {7u, 10u}) EXPECT_LT(cost_over_truth(seed), 1.01) << "seed " << seed;
}

TEST(CloseByLoopsOfManyTeams, EndAtTheCostOfTheTruthNearlyAlways) {
  int worse = 0;
  for (std::uint64_t seed = 101; seed <= 130; ++seed)
    if (cost_over_truth(seed) > 1.01) ++worse;
  EXPECT_LE(worse, 3);  // 21 without trials
}

}  // namespace
}  // namespace radioslam
