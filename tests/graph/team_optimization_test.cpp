// What every method must do with teams that are small, in parts or badly connected.
#include "radioslam/graph/distributed/team_optimization.hpp"

#include "graph/small_teams.hpp"

namespace radioslam {
namespace {

template <class Pose>
TeamOptimization<Pose> run(const test::SmallTeam<Pose>& team, DistributedMethod method,
                           const NetworkParams& network = {}, int rounds = 6000) {
  TeamOptimizationParams params;
  params.method = method;
  params.max_rounds = rounds;
  params.network = network;
  return optimize_team(team.graph, team.poses, params);
}

template <class Pose>
double cost_of(const test::SmallTeam<Pose>& team, const TeamOptimization<Pose>& result) {
  PoseGraph<Pose> graph = team.graph;
  graph.poses = result.poses;
  return total_cost(graph);
}

/// A robot that comes back to where it began, and measures that with an error.
template <class Pose>
test::SmallTeam<Pose> lone_robot(std::uint64_t seed) {
  auto team = test::draw_team<Pose>(seed, 1, 7, 1);
  RelativePoseFactor<Pose> loop = team.graph.relative_poses.front();
  loop.j = PoseId(6);
  loop.T_i_j = team.graph.poses.front().inverse() * team.graph.poses.back() *
               test::Drawing<Pose>(seed + 100).pose(0.5, 0.2);
  team.graph.relative_poses.push_back(loop);
  return team;
}

template <class Pose>
class EveryMethod : public testing::Test {
 public:
  /// The team stops by itself at the central optimum, in so many frames.
  static void expect_optimum(const test::SmallTeam<Pose>& team, std::size_t frames, double central) {
    for (const DistributedMethodInfo& info : kDistributedMethods) {
      const auto result = run(team, info.method);
      EXPECT_TRUE(result.settled) << info.name;
      EXPECT_EQ(result.refused, 0u) << info.name;
      EXPECT_NEAR(cost_of(team, result), central, 1e-3 * central + 1e-6) << info.name;
      std::set<std::pair<RobotNumber, std::uint32_t>> found;
      for (const Frame& frame : result.frames) found.emplace(frame.origin, frame.part);
      EXPECT_EQ(found.size(), frames) << info.name;
    }
  }
};
TYPED_TEST_SUITE(EveryMethod, test::PoseTypes);

TYPED_TEST(EveryMethod, LetsARobotWithoutNeighboursOptimiseItsOwnGraph) {
  const auto one = lone_robot<TypeParam>(1), other = lone_robot<TypeParam>(2);
  const double central = test::central_optimum(one.graph);
  EXPECT_GT(total_cost(one.graph), 2 * central);
  this->expect_optimum(one, 1, central);
  this->expect_optimum(test::side_by_side(one, other), 2, central + test::central_optimum(other.graph));
}

TYPED_TEST(EveryMethod, OptimisesEachPartOfATeam) {
  const auto linked = test::draw_team<TypeParam>(3, 2, 7, 1);
  const auto apart = test::side_by_side(lone_robot<TypeParam>(4), lone_robot<TypeParam>(5));
  const double central = test::central_optimum(linked.graph) + test::central_optimum(apart.graph);
  this->expect_optimum(test::side_by_side(linked, apart), 3, central);
  this->expect_optimum(test::side_by_side(apart, linked), 3, central);
}

TYPED_TEST(EveryMethod, EndsForRobotsOfOnePoseEach) {
  for (const auto& meetings : {test::chain_of(2), test::chain_of(4), test::ring_of(4), test::all_of(3)}) {
    const std::size_t robots = meetings.back().second + 1;
    const auto team = test::draw_team<TypeParam>(6, robots, 1, 1, meetings);
    this->expect_optimum(team, 1, test::central_optimum(team.graph));
  }
}

TYPED_TEST(EveryMethod, HasNothingToDoWithoutFactors) {
  test::SmallTeam<TypeParam> team;
  team.graph.poses.resize(3);
  team.poses = team_poses({0, 1, 2}, 3);
  this->expect_optimum(team, 3, 0);
}

TYPED_TEST(EveryMethod, ReachesTheOptimumOfAChainOfTenRobots) {
  const auto team = test::draw_team<TypeParam>(7, 10, 4, 1);
  this->expect_optimum(team, 1, test::central_optimum(team.graph));
}

TYPED_TEST(EveryMethod, LeavesAPartThatNothingTiesInAFrameOfItsOwn) {
  const auto team = test::cut(lone_robot<TypeParam>(8), 0, 3);
  auto apart = team;
  std::erase_if(apart.graph.relative_poses,
                [](const auto& f) { return f.j.index() == 6 && f.i.index() == 0; });
  this->expect_optimum(team, 1, test::central_optimum(team.graph));
  this->expect_optimum(apart, 2, 0);
}

// ---- bad networks ----

TYPED_TEST(EveryMethod, IsOnlySettledAtTheOptimumWhereItBearsTheNetwork) {
  const auto team = test::draw_team<TypeParam>(9, 3, 7, 1);
  const double central = test::central_optimum(team.graph);
  for (const DistributedMethodInfo& info : kDistributedMethods)
    for (const double loss : {0.0, 0.3, 0.9})
      for (const int delay : {0, 4}) {
        if ((loss > 0 && !info.bears_loss) || (delay > 0 && !info.bears_delay)) continue;
        const auto result = run(team, info.method, {loss, delay, 0.2, 5}, 2000);
        if (loss < 0.9) {
          EXPECT_TRUE(result.settled) << info.name << " " << loss << " " << delay;
        }
        if (result.settled) {
          EXPECT_NEAR(cost_of(team, result), central, 1e-3 * central)
              << info.name << " " << loss << " " << delay;
        }
      }
}

TYPED_TEST(EveryMethod, IsNotSettledWhereNothingIsHeard) {
  const auto team = test::draw_team<TypeParam>(10, 2, 4, 1);
  for (const DistributedMethodInfo& info : kDistributedMethods)
    EXPECT_FALSE(run(team, info.method, {1, 0, 0, 1}, 400).settled) << info.name;
}

}  // namespace
}  // namespace radioslam
