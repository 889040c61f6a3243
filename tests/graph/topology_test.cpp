#include "radioslam/graph/distributed/topology.hpp"

#include "graph/small_teams.hpp"

namespace radioslam {
namespace {

/// A team that gossips, without poses to speak of.
class Gossips {
 public:
  Gossips(std::size_t robots, const test::Meetings& meetings) {
    const auto team = test::draw_team<SE2>(1, robots, 2, 0, meetings);
    for (const auto& robot : split_by_robot(team.graph, team.poses)) {
      gossips_.emplace_back(robot);
      auto& links = links_.emplace_back();
      for (const NeighbourRobot& n : robot.neighbours) links.push_back(n.robot);
    }
  }
  /// Everybody tells the news to its neighbours; how many RobotLinks were sent.
  std::size_t round() {
    std::vector<std::tuple<RobotNumber, RobotNumber, std::vector<RobotLinks>>> sent;
    std::size_t count = 0;
    for (RobotNumber r = 0; r < gossips_.size(); ++r)
      for (const RobotNumber n : links_[r]) {
        sent.emplace_back(r, n, gossips_[r].news_for(n));
        count += std::get<2>(sent.back()).size();
      }
    for (const auto& [from, to, news] : sent) gossips_[to].hear(from, news);
    return count;
  }
  std::vector<TopologyGossip> gossips_;
  std::vector<std::vector<RobotNumber>> links_;
};

/// Steps between robots of a 3 x 3 grid.
std::size_t grid_distance(std::size_t a, std::size_t b) {
  const auto apart = [](std::size_t x, std::size_t y) { return x > y ? x - y : y - x; };
  return apart(a % 3, b % 3) + apart(a / 3, b / 3);
}

TEST(Topology, ARobotKnowsTheTeamAfterAsManyRoundsAsTheFurthestOneIsAway) {
  Gossips team(9, test::grid_of(3));
  for (std::size_t round = 0; round <= 4; ++round, team.round())
    for (std::size_t r = 0; r < 9; ++r) {
      std::size_t furthest = 0;
      for (std::size_t other = 0; other < 9; ++other) furthest = std::max(furthest, grid_distance(r, other));
      EXPECT_EQ(team.gossips_[r].complete(), round >= furthest) << r << " after " << round;
    }
  for (const auto& gossip : team.gossips_) {
    EXPECT_EQ(gossip.reachable(), team.gossips_[0].reachable());
    EXPECT_EQ(gossip.reachable().size(), 9u);
  }
  EXPECT_EQ(team.round(), 0u) << "nothing is told twice";
  team.gossips_[3].tell_again();
  EXPECT_GT(team.round(), 0u);
}

TEST(Topology, TheTreeIsAsHighAsTheTeamsRadius) {
  Gossips team(9, test::grid_of(3));
  for (int k = 0; k < 4; ++k) team.round();
  const TeamTree tree(team.gossips_[8].reachable());
  EXPECT_EQ(tree.root(), 4u);
  EXPECT_EQ(tree.height(), 2u);
  EXPECT_EQ(tree.id(), TeamTree(team.gossips_[0].reachable()).id());
  for (RobotNumber r = 0; r < 9; ++r) {
    EXPECT_EQ(tree.depth(r), grid_distance(r, 4));
    if (r != 4) {
      EXPECT_EQ(grid_distance(r, tree.parent(r)), 1u);
      EXPECT_EQ(tree.depth(tree.parent(r)) + 1, tree.depth(r));
      const auto siblings = tree.children(tree.parent(r));
      EXPECT_EQ(std::count(siblings.begin(), siblings.end(), r), 1);
    }
    EXPECT_EQ(tree.common_ancestor(r, r), r);
    EXPECT_EQ(tree.common_ancestor(r, 4), 4u);
    EXPECT_EQ(tree.common_ancestor(r, tree.parent(r)), tree.parent(r));
  }
  EXPECT_TRUE(tree.is_root(4));
  EXPECT_EQ(tree.common_ancestor(1, 7), 4u);
}

TEST(Topology, AHigherVersionReplacesALowerOne) {
  Gossips team(3, test::chain_of(3));
  TopologyGossip& gossip = team.gossips_[0];
  gossip.hear(1, {{1, 2, {0, 2}}, {2, 5, {1}}});
  EXPECT_TRUE(gossip.complete());
  EXPECT_EQ(gossip.reachable().size(), 3u);
  gossip.hear(1, {{2, 4, {}}});
  EXPECT_EQ(gossip.reachable().size(), 3u) << "older";
  gossip.hear(1, {{2, 6, {}}});
  EXPECT_EQ(gossip.reachable().size(), 2u) << "newer";
  gossip.hear(1, {{0, 9, {}}});
  EXPECT_EQ(gossip.reachable().size(), 2u) << "a robot knows best whom it is connected to";
}

TEST(Topology, ALinkCountsWhenBothEndsConfirmIt) {
  Gossips team(4, test::chain_of(4));
  for (int k = 0; k < 3; ++k) team.round();
  const auto id = TeamTree(team.gossips_[0].reachable()).id();
  team.gossips_[2].drop(1);
  team.round();
  EXPECT_TRUE(team.gossips_[1].complete());
  EXPECT_EQ(team.gossips_[1].reachable().size(), 2u);
  EXPECT_EQ(team.gossips_[3].reachable().size(), 2u);
  team.gossips_[2].restore(1);
  for (int k = 0; k < 3; ++k) team.round();
  EXPECT_EQ(team.gossips_[0].reachable().size(), 4u);
  EXPECT_NE(TeamTree(team.gossips_[0].reachable()).id(), id) << "another team than the first";
}

TEST(Topology, IncompleteWhileALinkedRobotIsUnknown) {
  Gossips team(3, test::chain_of(3));
  EXPECT_FALSE(team.gossips_[0].complete());
  team.gossips_[0].hear(1, {{1, 0, {0, 2}}});
  EXPECT_FALSE(team.gossips_[0].complete());
  team.gossips_[0].drop(1);
  EXPECT_TRUE(team.gossips_[0].complete()) << "alone";
}

}  // namespace
}  // namespace radioslam
