#include "radioslam/graph/distributed/separators.hpp"

#include <functional>

#include "graph/small_teams.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/graph/distributed/team_optimization.hpp"
#include "radioslam/graph/residuals.hpp"

namespace radioslam {
namespace {

template <class Pose>
TeamOptimization<Pose> run(const test::SmallTeam<Pose>& team,
                           DistributedMethod method = DistributedMethod::kSeparators,
                           NetworkParams network = {}, int rounds = 3000) {
  TeamOptimizationParams params;
  params.method = method;
  params.max_rounds = rounds;
  params.network = network;
  return optimize_team(team.graph, team.poses, params);
}

/// Diameter of the graph of robots, and its radius, which is the height of the tree.
struct Distances {
  std::size_t diameter = 0, radius = 0;
};
Distances distances(std::size_t robots, const test::Meetings& meetings) {
  std::vector<std::vector<std::size_t>> d(robots, std::vector<std::size_t>(robots, robots));
  for (std::size_t r = 0; r < robots; ++r) d[r][r] = 0;
  for (const auto& [a, b] : meetings) d[a][b] = d[b][a] = 1;
  for (std::size_t k = 0; k < robots; ++k)
    for (std::size_t a = 0; a < robots; ++a)
      for (std::size_t b = 0; b < robots; ++b) d[a][b] = std::min(d[a][b], d[a][k] + d[k][b]);
  Distances result{0, robots};
  for (const auto& from : d) {
    const std::size_t furthest = *std::max_element(from.begin(), from.end());
    result.diameter = std::max(result.diameter, furthest);
    result.radius = std::min(result.radius, furthest);
  }
  return result;
}

struct Shape {
  std::size_t robots;
  test::Meetings meetings;
};
const std::vector<Shape>& shapes() {
  static const std::vector<Shape> kShapes{
      {2, test::chain_of(2)}, {5, test::chain_of(5)}, {4, test::ring_of(4)}, {4, test::all_of(4)}};
  return kShapes;
}

template <class Pose>
class Separators : public testing::Test {};
TYPED_TEST_SUITE(Separators, test::PoseTypes);

TYPED_TEST(Separators, ReachTheCentralOptimumInOneFrame) {
  for (const Shape& shape : shapes()) {
    const auto team = test::draw_team<TypeParam>(shape.robots, shape.robots, 7, 1, shape.meetings);
    const auto result = run(team);
    EXPECT_TRUE(result.settled);
    EXPECT_EQ(result.refused, 0u);
    for (const auto& frame : result.frames) EXPECT_TRUE(frame.same({0, 0, 0}));
    const double central = test::central_optimum(team.graph);
    EXPECT_NEAR(result.rounds.back().cost, central, 1e-6 * central);
  }
}

/// The lowest robot's frame reaches all others in `diameter` rounds, and the poses told last arrive in one
/// more. A sweep is `radius` rounds up and as many down; the robots show its values when the last one has
/// them. Gauss-Newton from odometry's values needs no more than six.
TYPED_TEST(Separators, NeedRoundsOfTheOrderOfTheTeamsDiameter) {
  for (const Shape& shape : shapes()) {
    const auto team = test::draw_team<TypeParam>(shape.robots + 10, shape.robots, 7, 1, shape.meetings);
    const auto result = run(team);
    const double central = test::central_optimum(team.graph);
    std::size_t rounds = result.rounds.size();
    while (rounds > 0 && result.rounds[rounds - 1].one_frame &&
           result.rounds[rounds - 1].cost < central * (1 + 1e-3))
      --rounds;
    const Distances d = distances(shape.robots, shape.meetings);
    EXPECT_LE(rounds + 1, d.diameter + 2 + 6 * 2 * d.radius) << shape.robots;
    EXPECT_LT(rounds, result.rounds.size());
  }
}

TYPED_TEST(Separators, ARobotInTwoPartsIsJoinedByTheOthers) {
  for (const RobotNumber robot : {0u, 1u}) {
    const auto team = test::cut(test::draw_team<TypeParam>(3, 3, 7, 1), robot, 4);
    const auto result = run(team);
    EXPECT_TRUE(result.settled);
    const double central = test::central_optimum(team.graph);
    EXPECT_NEAR(result.rounds.back().cost, central, 1e-6 * central);
  }
}

TYPED_TEST(Separators, APartThatNobodySeesStaysInItsOwnFrame) {
  for (const RobotNumber robot : {0u, 1u, 2u})
    for (const bool first : {true, false}) {
      // Nobody but the robot itself sees its poses up to the third, or after it.
      auto team = test::cut(test::draw_team<TypeParam>(3, 3, 7, 1), robot, 2);
      const auto hidden = [&](PoseId p) {
        const std::size_t k = p.index() % 7;
        return p.index() / 7 == robot && (first ? k <= 2 : k > 2);
      };
      std::erase_if(team.graph.relative_poses, [&](const auto& f) {
        return f.i.index() / 7 != f.j.index() / 7 && (hidden(f.i) || hidden(f.j));
      });
      const auto result = run(team);
      EXPECT_TRUE(result.settled);
      const double central = test::central_optimum(team.graph);  // of the chain alone it is zero
      EXPECT_NEAR(result.rounds.back().cost, central, 1e-6 * central + 1e-9);
      for (std::size_t p = 0; p < team.graph.poses.size(); ++p)
        EXPECT_EQ(result.frames[p].same({0, 0, 0}), !hidden(PoseId(p))) << p;
    }
}

TYPED_TEST(Separators, TeamsThatDoNotMeetHaveTwoFrames) {
  const auto two = test::draw_team<TypeParam>(4, 2, 7, 1), three = test::draw_team<TypeParam>(5, 3, 7, 1);
  const auto result = run(test::side_by_side(two, three));
  EXPECT_TRUE(result.settled);
  EXPECT_TRUE(result.frames.front().same({0, 0, 0}));
  EXPECT_TRUE(result.frames.back().same({2, 0, 0}));
  const double central = test::central_optimum(two.graph) + test::central_optimum(three.graph);
  EXPECT_NEAR(result.rounds.back().cost, central, 1e-6 * central);
}

TYPED_TEST(Separators, ARobotAloneIsSettled) {
  EXPECT_TRUE(run(test::draw_team<TypeParam>(6, 1, 7, 1)).settled);
}

TYPED_TEST(Separators, DoNotClaimToBeSettledWhereMessagesAreLost) {
  NetworkParams network;
  network.loss_share = 0.3;
  EXPECT_FALSE(
      run(test::draw_team<TypeParam>(7, 5, 7, 1), DistributedMethod::kSeparators, network, 300).settled);
}

TYPED_TEST(Separators, GiveTheSameBytesForAnyNumberOfThreads) {
  const auto team = test::draw_team<TypeParam>(8, 4, 7, 1, test::all_of(4));
  std::vector<TeamOptimization<TypeParam>> results;
  for (const std::size_t threads : {1u, 4u}) {
    set_thread_count(threads);
    results.push_back(run(team));
  }
  set_thread_count(0);
  ASSERT_EQ(results[0].rounds.size(), results[1].rounds.size());
  for (std::size_t k = 0; k < results[0].rounds.size(); ++k)
    EXPECT_EQ(results[0].rounds[k].cost, results[1].rounds[k].cost);
  for (std::size_t p = 0; p < team.graph.poses.size(); ++p)
    EXPECT_EQ(results[0].poses[p].translation(), results[1].poses[p].translation());
}

// ---- bad networks ----

TYPED_TEST(Separators, WithRepeatsReachTheOptimumThroughBadNetworks) {
  for (const double loss : {0.2, 0.5})
    for (const int delay : {0, 5, 10}) {
      NetworkParams network{loss, delay, 0.3, delay + 1};
      const auto team = test::draw_team<TypeParam>(9, 4, 7, 1, test::ring_of(4));
      const auto result = run(team, DistributedMethod::kAsynchronous, network);
      EXPECT_TRUE(result.settled) << loss << " " << delay;
      EXPECT_EQ(result.refused, 0u);
      const double central = test::central_optimum(team.graph);
      EXPECT_NEAR(result.rounds.back().cost, central, 1e-3 * central) << loss << " " << delay;
    }
}

/// Whether a message from a robot reaches another in a round.
using Hears = std::function<bool(RobotNumber from, RobotNumber to, int round)>;

/// A team whose robots come and go.
template <class Pose>
class ChangingTeam {
 public:
  explicit ChangingTeam(const test::SmallTeam<Pose>& team) : team_(team) {
    SeparatorsParams params;
    params.repeat_after = 3;
    params.lost_after = 27;  // nine messages
    for (const auto& robot : split_by_robot(team.graph, team.poses))
      solvers_.push_back(std::make_unique<SeparatorsSolver<Pose>>(robot, params));
    inbox_.resize(solvers_.size());
  }

  /// `there`: robots that run at all.
  void play(int rounds, const std::function<bool(RobotNumber, int)>& there, const Hears& hears) {
    for (int k = 0; k < rounds; ++k, ++round_) {
      std::vector<std::vector<Message<Pose>>> next(solvers_.size());
      for (RobotNumber r = 0; r < solvers_.size(); ++r) {
        if (!there(r, round_)) continue;
        for (auto& message : solvers_[r]->round(inbox_[r]))
          if (hears(r, message.to, round_)) next[message.to].push_back(std::move(message));
      }
      inbox_ = std::move(next);
    }
  }

  /// Some robots have stopped in one frame, at the optimum of what they know together.
  void expect_optimum(const std::vector<RobotNumber>& robots, const std::string& what) const {
    auto part = test::only(team_, robots);
    std::vector<Frame> frames;
    part.graph.poses.clear();
    for (const RobotNumber r : robots) {
      EXPECT_TRUE(solvers_[r]->settled()) << what << ": robot " << r;
      EXPECT_EQ(solvers_[r]->refused(), 0u) << what;
      for (const Frame& frame : solvers_[r]->frames())
        EXPECT_TRUE(frame.same({robots.front(), 0, 0})) << what << ": " << r << " in " << frame.origin;
      const auto poses = solvers_[r]->poses();
      part.graph.poses.insert(part.graph.poses.end(), poses.begin(), poses.end());
    }
    double cost = 0;
    for (const auto& f : part.graph.relative_poses) cost += squared_norm(part.graph, f);
    const double central = test::central_optimum(part.graph);
    EXPECT_NEAR(cost, central, 1e-3 * central + 1e-9) << what;
  }

 private:
  test::SmallTeam<Pose> team_;
  std::vector<std::unique_ptr<DistributedSolver<Pose>>> solvers_;
  std::vector<std::vector<Message<Pose>>> inbox_;
  int round_ = 0;
};

bool always(RobotNumber, RobotNumber, int) { return true; }
/// One of five messages is lost, the same in every run.
Hears mostly() {
  return [rng = Rng(1)](RobotNumber, RobotNumber, int) mutable { return rng.uniform() > 0.2; };
}

TYPED_TEST(Separators, TheOthersFinishWithoutARobotThatGoesSilent) {
  const auto team = test::draw_team<TypeParam>(11, 4, 4, 1, test::ring_of(4));
  for (const RobotNumber gone : {0u, 2u})
    for (const auto& hears : {Hears(always), mostly()})
      for (const int at : {0, 1, 2, 3, 5, 6, 7, 8, 9, 10, 11, 13, 16, 40}) {
        ChangingTeam<TypeParam> robots(team);
        robots.play(
            300, [&](RobotNumber r, int round) { return r != gone || round < at; }, hears);
        std::vector<RobotNumber> rest{0, 1, 2, 3};
        std::erase(rest, gone);
        robots.expect_optimum(rest, std::to_string(gone) + " gone at " + std::to_string(at));
      }
}

TYPED_TEST(Separators, ARobotThatJoinsLateIsTakenIn) {
  const auto team = test::draw_team<TypeParam>(12, 3, 4, 1, test::all_of(3));
  for (const RobotNumber late : {0u, 1u, 2u})
    for (const auto& hears : {Hears(always), mostly()})
      for (const int at : {5, 15, 28, 30, 33, 120}) {
        ChangingTeam<TypeParam> robots(team);
        const auto there = [&](RobotNumber r, int round) { return r != late || round >= at; };
        const std::string what = std::to_string(late) + " joins at " + std::to_string(at);
        robots.play(at, there, hears);
        if (at == 120) {
          std::vector<RobotNumber> early{0, 1, 2};
          std::erase(early, late);
          robots.expect_optimum(early, what);
        }
        robots.play(200, there, hears);
        robots.expect_optimum({0, 1, 2}, what);
      }
}

TYPED_TEST(Separators, HalvesThatCannotHearEachOtherHaveTwoFramesUntilTheyCan) {
  const auto team = test::draw_team<TypeParam>(13, 4, 4, 1);
  const auto all = [](RobotNumber, int) { return true; };
  const auto apart = [](RobotNumber from, RobotNumber to, int) { return (from < 2) == (to < 2); };
  for (const int together : {0, 6, 10, 12, 50}) {
    const std::string what = "apart after " + std::to_string(together);
    ChangingTeam<TypeParam> robots(team);
    robots.play(together, all, always);
    robots.play(150, all, apart);
    robots.expect_optimum({0, 1}, what);
    robots.expect_optimum({2, 3}, what);
    robots.play(150, all, mostly());
    robots.expect_optimum({0, 1, 2, 3}, what + ", together again");
  }
}

}  // namespace
}  // namespace radioslam
