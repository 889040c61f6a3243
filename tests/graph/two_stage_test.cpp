#include "radioslam/graph/distributed/two_stage.hpp"

#include <map>

#include "graph/small_teams.hpp"
#include "radioslam/graph/distributed/team_optimization.hpp"

namespace radioslam {
namespace {

template <class Pose>
TeamOptimization<Pose> run(const test::SmallTeam<Pose>& team, NetworkParams network = {}, int rounds = 4000) {
  TeamOptimizationParams params;
  params.method = DistributedMethod::kTwoStage;
  params.max_rounds = rounds;
  params.network = network;
  return optimize_team(team.graph, team.poses, params);
}

template <class Pose>
std::unique_ptr<DistributedSolver<Pose>> make_solver(const RobotGraph<Pose>& robot) {
  return std::make_unique<TwoStageSolver<Pose>>(robot, TwoStageParams{});
}

template <class Pose>
class TwoStage : public testing::Test {};
TYPED_TEST_SUITE(TwoStage, test::PoseTypes);

TYPED_TEST(TwoStage, ReachesWhatTheStagesGiveCentrally) {
  for (const std::size_t robots : {2u, 4u}) {
    const auto team = test::draw_team<TypeParam>(robots, robots, 7, 1);
    const auto result = run(team);
    EXPECT_TRUE(result.settled);
    EXPECT_EQ(result.refused, 0u);
    for (const auto& frame : result.frames) EXPECT_TRUE(frame.same({0, 0, 0}));
    const double central = test::central_optimum(team.graph);
    EXPECT_NEAR(result.rounds.back().cost, central, 1e-3 * central);
  }
}

TYPED_TEST(TwoStage, IsExactWithoutNoise) {
  const auto team = test::draw_team<TypeParam>(1, 3, 7, 0);
  const auto result = run(team);
  EXPECT_TRUE(result.settled);
  EXPECT_LT(result.rounds.back().cost, 1e-6);
}

TYPED_TEST(TwoStage, LeavesTheFirstPoseOfTheLowestRobotInPlace) {
  const auto team = test::draw_team<TypeParam>(2, 3, 7, 1);
  const auto result = run(team);
  EXPECT_LT((result.poses[0].inverse() * team.graph.poses[0]).log().norm(), 1e-9);
}

TYPED_TEST(TwoStage, ARobotInTwoPartsIsJoinedByTheOthers) {
  for (const RobotNumber robot : {0u, 1u}) {
    const auto team = test::cut(test::draw_team<TypeParam>(3, 3, 7, 1), robot, 4);
    const auto result = run(team);
    EXPECT_TRUE(result.settled);
    const double central = test::central_optimum(team.graph);
    EXPECT_NEAR(result.rounds.back().cost, central, 1e-3 * central);
  }
}

TYPED_TEST(TwoStage, TeamsThatDoNotMeetHaveTwoFrames) {
  const auto two = test::draw_team<TypeParam>(4, 2, 7, 1), three = test::draw_team<TypeParam>(5, 3, 7, 1);
  const auto both = test::side_by_side(two, three);
  const auto result = run(both);
  EXPECT_TRUE(result.settled);
  EXPECT_TRUE(result.frames.front().same({0, 0, 0}));
  EXPECT_TRUE(result.frames.back().same({2, 0, 0}));
  const double central = test::central_optimum(two.graph) + test::central_optimum(three.graph);
  EXPECT_NEAR(result.rounds.back().cost, central, 1e-3 * central);
}

TYPED_TEST(TwoStage, ARobotAloneIsSettled) {
  EXPECT_TRUE(run(test::draw_team<TypeParam>(6, 1, 7, 1)).settled);
}

TYPED_TEST(TwoStage, SaysThatItCannotWhereMessagesAreLost) {
  NetworkParams network;
  network.loss_share = 0.3;
  const auto result = run(test::draw_team<TypeParam>(7, 5, 7, 1), network, 300);
  EXPECT_FALSE(result.settled);
}

TYPED_TEST(TwoStage, MessagesAreAboutThePosesThatTheReceiverSees) {
  test::for_each_message(test::draw_team<TypeParam>(8, 3, 7, 1), 400, make_solver<TypeParam>,
                         test::expect_about_poses_seen<TypeParam>);
}

TYPED_TEST(TwoStage, AStageBeginsWithWhereItStarts) {
  std::map<std::pair<RobotNumber, RobotNumber>, std::uint32_t> stage_told;
  test::for_each_message(test::draw_team<TypeParam>(8, 6, 7, 1), 2000, make_solver<TypeParam>,
                         [&](const auto&, const auto&, const Message<TypeParam>& message) {
                           ASSERT_TRUE(message.stage);
                           auto& told = stage_told.try_emplace({message.from, message.to}, ~0U).first->second;
                           if (told == message.stage->stage) return;
                           told = message.stage->stage;
                           const bool tells =
                               told == 1 ? !message.matrices.empty() : message.seen.has_value();
                           EXPECT_TRUE(tells || message.stage->finished);
                         });
  for (const auto& [link, stage] : stage_told) EXPECT_GT(stage, 3u);
}

TYPED_TEST(TwoStage, RefusesWhatDoesNotFitItsFactors) {
  const auto team = test::draw_team<TypeParam>(9, 2, 7, 1);
  TwoStageSolver<TypeParam> solver(split_by_robot(team.graph, team.poses)[0], {});
  solver.round({});
  Message<TypeParam> message;
  message.from = 1;
  const auto refused_with = [&](const auto& change) {
    Message<TypeParam> changed = message;
    changed.stage = StageNews{};
    change(changed);
    const std::size_t before = solver.refused();
    solver.round({changed});
    return solver.refused() - before;
  };
  EXPECT_EQ(refused_with([](auto&) {}), 0u);
  EXPECT_EQ(refused_with([](auto& m) { m.stage.reset(); }), 1u);
  EXPECT_EQ(refused_with([](auto& m) { m.from = 5; }), 1u);
  EXPECT_EQ(refused_with([](auto& m) { m.matrices.resize(3); }), 1u);
  EXPECT_EQ(refused_with([](auto& m) { m.seen.emplace().poses.resize(1); }), 1u);
  EXPECT_EQ(refused_with([](auto& m) { m.stage->stage = 3; }), 1u);
  // Nobody can have left the frames before this robot knows the team.
  EXPECT_EQ(refused_with([](auto& m) { m.stage->stage = 1; }), 0u);
  EXPECT_FALSE(solver.settled());
}

}  // namespace
}  // namespace radioslam
