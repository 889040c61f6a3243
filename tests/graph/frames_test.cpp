#include "radioslam/graph/distributed/frames.hpp"

#include <functional>

#include "graph/small_teams.hpp"

namespace radioslam {
namespace {

/// Two robots without noise; some of the ten loops between them are wrong.
template <class Pose>
struct Pair {
  explicit Pair(const std::function<Pose(std::size_t loop)>& error) {
    auto team = test::draw_team<Pose>(1, 2, 10, 0, test::chain_of(2), 1);
    std::size_t loop = 0;
    for (auto& f : team.graph.relative_poses)
      if (f.i.index() < 10 && f.j.index() >= 10) f.T_i_j = f.T_i_j * error(loop++);
    robots = split_by_robot(team.graph, team.poses);
    // Where the second robot is in the first one's frame, by the last loop, which is right.
    T_first_second = team.graph.poses[9] * truth_of_last(team) * team.graph.poses[19].inverse();
  }
  static Pose truth_of_last(const test::SmallTeam<Pose>& team) {
    for (const auto& f : team.graph.relative_poses)
      if (f.i.index() == 9 && f.j.index() == 19) return f.T_i_j;
    return {};
  }
  /// The second robot hears the first.
  double error_of_adopted(const FrameVoteParams& params) {
    FrameAgreement<Pose> first(robots[0], params), second(robots[1], params);
    const auto start = robots[1].graph.poses;
    EXPECT_TRUE(second.hear(robots[1], 0, first.seen_by(robots[0], robots[0].neighbours[0])));
    EXPECT_TRUE(second.adopt(robots[1]));
    EXPECT_TRUE(second.frame_of_part(0).same({0, 0, 0}));
    EXPECT_EQ(second.frame_of_part(0).hops, 1u);
    EXPECT_FALSE(second.adopt(robots[1])) << "there is nothing lower";
    double worst = 0;
    for (std::size_t p = 0; p < robots[1].own_poses; ++p)
      worst =
          std::max(worst, ((T_first_second * start[p]).inverse() * robots[1].graph.poses[p]).log().norm());
    return worst;
  }
  std::vector<RobotGraph<Pose>> robots;
  Pose T_first_second;
};

template <class Pose>
class Frames : public testing::Test {};
TYPED_TEST_SUITE(Frames, test::PoseTypes);

TYPED_TEST(Frames, TheMajorityWinsAgainstScatteredPlacements) {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u}) {
    test::Drawing<TypeParam> draw(seed);
    Pair<TypeParam> pair([&](std::size_t loop) { return loop < 4 ? draw.pose(10, 2) : TypeParam(); });
    EXPECT_LT(pair.error_of_adopted({}), 1e-6);
  }
}

TYPED_TEST(Frames, TheMajorityWinsAgainstPlacementsThatAgree) {
  test::Drawing<TypeParam> draw(6);
  const TypeParam elsewhere = draw.pose(10, 2);
  // T_i_j = T_i^-1 D T_j with one D places the robot elsewhere, alike by every one of these loops.
  auto team = test::draw_team<TypeParam>(1, 2, 10, 0, test::chain_of(2), 1);
  std::vector<TypeParam> errors;
  for (const auto& f : team.graph.relative_poses)
    if (f.i.index() < 10 && f.j.index() >= 10) {
      const TypeParam& i = team.graph.poses[f.i.index()];
      errors.push_back(f.T_i_j.inverse() * i.inverse() * elsewhere * i * f.T_i_j);
    }
  Pair<TypeParam> pair([&](std::size_t loop) { return loop < 4 ? errors[loop] : TypeParam(); });
  EXPECT_LT(pair.error_of_adopted({}), 1e-6);
}

TYPED_TEST(Frames, NoFrameIsAdoptedWithoutEnoughVotes) {
  Pair<TypeParam> pair([](std::size_t) { return TypeParam(); });
  FrameVoteParams params;
  params.min_votes = 11;
  FrameAgreement<TypeParam> first(pair.robots[0], params), second(pair.robots[1], params);
  second.hear(pair.robots[1], 0, first.seen_by(pair.robots[0], pair.robots[0].neighbours[0]));
  EXPECT_FALSE(second.adopt(pair.robots[1]));
  EXPECT_TRUE(second.frame_of_part(0).same({1, 0, 0}));
  EXPECT_TRUE(second.usable_factors(pair.robots[1]).empty());
}

TYPED_TEST(Frames, NobodyAdoptsTheFrameOfAHigherRobot) {
  Pair<TypeParam> pair([](std::size_t) { return TypeParam(); });
  FrameAgreement<TypeParam> first(pair.robots[0], {}), second(pair.robots[1], {});
  first.hear(pair.robots[0], 1, second.seen_by(pair.robots[1], pair.robots[1].neighbours[0]));
  EXPECT_FALSE(first.adopt(pair.robots[0]));
}

TYPED_TEST(Frames, RefusesPosesThatDoNotFit) {
  Pair<TypeParam> pair([](std::size_t) { return TypeParam(); });
  FrameAgreement<TypeParam> first(pair.robots[0], {}), second(pair.robots[1], {});
  auto seen = first.seen_by(pair.robots[0], pair.robots[0].neighbours[0]);
  EXPECT_FALSE(second.hear(pair.robots[1], 5, seen));
  seen.poses.pop_back();
  EXPECT_FALSE(second.hear(pair.robots[1], 0, seen));
  EXPECT_FALSE(second.frame_of(pair.robots[1], pair.robots[1].own_poses)) << "nothing was heard";
}

TYPED_TEST(Frames, AfterAStartAgainThePartsThatAreSeenComeFirst) {
  const auto team = test::cut(test::draw_team<TypeParam>(3, 2, 8, 1), 1, 3);
  auto robots = split_by_robot(team.graph, team.poses);
  FrameAgreement<TypeParam> first(robots[0], {}), second(robots[1], {});
  second.hear(robots[1], 0, first.seen_by(robots[0], robots[0].neighbours[0]));
  second.adopt(robots[1]);
  second.start_again(robots[1], {6});
  EXPECT_TRUE(second.frame_of(robots[1], 6)->same({1, 0, 0}));
  EXPECT_TRUE(second.frame_of(robots[1], 0)->same({1, 1, 0}));
  EXPECT_FALSE(second.frame_of(robots[1], robots[1].own_poses));
}

TYPED_TEST(Frames, PartsThatOthersSeeAreNumberedFirst) {
  auto team = test::cut(test::draw_team<TypeParam>(3, 2, 7, 1), 0, 1);
  std::erase_if(team.graph.relative_poses,
                [](const auto& f) { return f.i.index() == 0 && f.j.index() >= 7; });
  const auto robots = split_by_robot(team.graph, team.poses);
  EXPECT_EQ(robots[0].parts, 2u);
  EXPECT_EQ(robots[0].part_of, (std::vector<std::uint32_t>{1, 1, 0, 0, 0, 0, 0}));
}

}  // namespace
}  // namespace radioslam
