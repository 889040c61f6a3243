#include "radioslam/graph/distributed/alternating.hpp"

#include "graph/small_teams.hpp"
#include "radioslam/graph/distributed/team_optimization.hpp"

namespace radioslam {
namespace {

template <class Pose>
TeamOptimization<Pose> run(const test::SmallTeam<Pose>& team, NetworkParams network = {}, int rounds = 6000) {
  TeamOptimizationParams params;
  params.method = DistributedMethod::kAlternating;
  params.max_rounds = rounds;
  params.network = network;
  return optimize_team(team.graph, team.poses, params);
}

template <class Pose>
std::unique_ptr<DistributedSolver<Pose>> make_solver(const RobotGraph<Pose>& robot) {
  return std::make_unique<AlternatingSolver<Pose>>(robot, AlternatingParams{});
}

template <class Pose>
class Alternating : public testing::Test {};
TYPED_TEST_SUITE(Alternating, test::PoseTypes);

TYPED_TEST(Alternating, ReachesTheCentralOptimum) {
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

TYPED_TEST(Alternating, NoRoundRaisesTheCostOnceTheFrameIsCommon) {
  const auto result = run(test::draw_team<TypeParam>(4, 4, 7, 1), {}, 300);
  for (std::size_t k = 10; k < result.rounds.size(); ++k)
    EXPECT_LE(result.rounds[k].cost, result.rounds[k - 1].cost * (1 + 1e-6)) << k;
}

TYPED_TEST(Alternating, ARobotInTwoPartsIsJoinedByTheOthers) {
  for (const RobotNumber robot : {0u, 1u}) {
    const auto team = test::cut(test::draw_team<TypeParam>(3, 3, 7, 1), robot, 4);
    const auto result = run(team);
    EXPECT_TRUE(result.settled);
    const double central = test::central_optimum(team.graph);
    EXPECT_NEAR(result.rounds.back().cost, central, 1e-3 * central);
  }
}

TYPED_TEST(Alternating, TeamsThatDoNotMeetHaveTwoFrames) {
  const auto two = test::draw_team<TypeParam>(4, 2, 7, 1), three = test::draw_team<TypeParam>(5, 3, 7, 1);
  const auto both = test::side_by_side(two, three);
  const auto result = run(both);
  EXPECT_TRUE(result.settled);
  EXPECT_TRUE(result.frames.front().same({0, 0, 0}));
  EXPECT_TRUE(result.frames.back().same({2, 0, 0}));
  const double central = test::central_optimum(two.graph) + test::central_optimum(three.graph);
  EXPECT_NEAR(result.rounds.back().cost, central, 1e-3 * central);
}

TYPED_TEST(Alternating, ARobotAloneIsSettled) {
  EXPECT_TRUE(run(test::draw_team<TypeParam>(6, 1, 7, 1)).settled);
}

TYPED_TEST(Alternating, MessagesAreAboutThePosesThatTheReceiverSees) {
  test::for_each_message(test::draw_team<TypeParam>(8, 3, 7, 1), 50, make_solver<TypeParam>,
                         test::expect_about_poses_seen<TypeParam>);
}

}  // namespace
}  // namespace radioslam
