#include "radioslam/graph/distributed/condensed/known_team.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "radioslam/base/random.hpp"
#include "radioslam/graph/initial_values.hpp"
#include "radioslam/graph/marginals.hpp"
#include "radioslam/graph/optimizer.hpp"

namespace radioslam {
namespace {

constexpr double kSigma_m = 0.05, kSigma_rad = 0.02;
const AngleEvidence kNoAngles{};

SE2 with_noise(const SE2& pose, Rng& rng) {
  return pose * SE2::exp({rng.normal(0, kSigma_m), rng.normal(0, kSigma_m), rng.normal(0, kSigma_rad)});
}

/// Robots that walk circles side by side, see each other at times, and what a central graph knows of it.
struct Walk {
  std::vector<KnownTeam> team;
  std::vector<SE2> truth;
  PoseGraph2 central;
  std::vector<std::vector<PoseId>> ids;
  Rng rng{7};

  explicit Walk(std::size_t robots, bool starts_known) {
    for (std::size_t k = 0; k < robots; ++k) {
      const SE2 start({3.0 * static_cast<double>(k), 0}, 0.3);
      team.emplace_back(name(k), 0, starts_known ? std::optional(start) : std::nullopt, KnownTeamParams{});
      truth.push_back(start);
      ids.push_back({});
      add_pose(k, start);
      central.pose_fixed.push_back(starts_known || k == 0);
    }
  }
  static std::string name(std::size_t k) { return std::string(1, static_cast<char>('a' + k)); }
  void add_pose(std::size_t robot, const SE2& pose) {
    ids[robot].push_back(PoseId(central.poses.size()));
    central.poses.push_back(pose);
  }
  void factor(PoseId i, PoseId j, const SE2& T) {
    const SE2::Tangent information(1 / (kSigma_m * kSigma_m), 1 / (kSigma_m * kSigma_m),
                                   1 / (kSigma_rad * kSigma_rad));
    central.relative_poses.push_back({i, j, T, information.asDiagonal()});
  }
  void move(std::size_t k, double t_s) {
    const SE2 step({0.8, 0}, 0.15), measured = with_noise(step, rng);
    truth[k] = truth[k] * step;
    team[k].move(t_s, measured, kSigma_m, kSigma_rad);
    add_pose(k, central.poses[ids[k].back().index()] * measured);
    central.pose_fixed.push_back(false);
    factor(ids[k][ids[k].size() - 2], ids[k].back(), measured);
  }
  void see(std::size_t i, std::size_t j, double t_s) {
    const SE2 measured = with_noise(truth[i].inverse() * truth[j], rng);
    team[i].see(t_s, name(j), measured, kSigma_m, kSigma_rad, kNoAngles);
    factor(ids[i].back(), ids[j].back(), measured);
  }
  void share_all(double t_s) {
    // Whoever was seen learns of it from the others' parts, and then shares the poses that were seen.
    for (int round = 0; round < 2; ++round)
      for (auto& from : team)
        for (auto& to : team) to.take(from.own_part(t_s));
  }
};

void expect_same_as_central(Walk& walk) {
  initialise_from_spanning_tree(walk.central);
  optimize(walk.central, OptimizerParams{});
  const auto marginals = Marginals<SE2>::compute(walk.central);
  ASSERT_TRUE(marginals);
  for (std::size_t k = 0; k < walk.team.size(); ++k) {
    ASSERT_TRUE(walk.team[k].solve());
    const auto& poses = walk.team[k].poses();
    ASSERT_EQ(poses.size(), walk.ids[k].size());
    for (std::size_t n = 0; n < poses.size(); ++n)
      EXPECT_LT((walk.central.poses[walk.ids[k][n].index()].inverse() * poses[n]).log().norm(), 0.01);
    const SE2::Jacobian central = marginals->pose(walk.ids[k].back());
    EXPECT_LT((walk.team[k].latest().covariance - central).norm(), 0.05 * central.norm());
  }
}

TEST(KnownTeam, EveryRobotThatKnowsAllPartsHasTheCentralEstimateAndItsCovariance) {
  Walk walk(3, true);
  for (int t = 1; t <= 40; ++t) {
    for (std::size_t k = 0; k < 3; ++k) walk.move(k, t);
    if (t % 10 == 0) walk.see(0, 1, t);
    if (t % 13 == 0) walk.see(2, 1, t);
    if (t % 17 == 0) walk.see(1, 2, t);
  }
  walk.share_all(40);
  expect_same_as_central(walk);
}

TEST(KnownTeam, RobotsWithoutStartsAgreeOnTheFrameOfTheFirst) {
  Walk walk(3, false);
  for (int t = 1; t <= 20; ++t) {
    for (std::size_t k = 0; k < 3; ++k) walk.move(k, t);
    if (t % 7 == 0) walk.see(0, 1, t);
    if (t % 9 == 0) walk.see(1, 2, t);
  }
  walk.share_all(20);
  for (std::size_t k = 0; k < 3; ++k) {
    walk.team[k].solve();
    EXPECT_EQ(walk.team[k].frame(), "a");
    EXPECT_EQ(walk.team[k].team(), (std::vector<std::string>{"a", "b", "c"}));
  }
  const SE2 first = SE2({0, 0}, 0.3);
  const auto& latest = walk.team[2].latest();
  const SE2::Tangent error = (latest.pose.inverse() * (first.inverse() * walk.truth[2])).log();
  EXPECT_LT(error.dot(latest.covariance.inverse() * error), 16);  // chi-squared with 3: once in a thousand
}

TEST(KnownTeam, PartsMayComeTwiceAndInAnyOrder) {
  Walk walk(2, true);
  std::vector<KnownTeam::PartPointer> parts;
  for (int t = 1; t <= 30; ++t) {
    for (std::size_t k = 0; k < 2; ++k) walk.move(k, t);
    if (t % 5 == 0) walk.see(1, 0, t);
    parts.push_back(walk.team[1].own_part(t));
  }
  KnownTeam other = walk.team[0];
  for (const auto& part : parts) walk.team[0].take(part);
  for (auto part = parts.rbegin(); part != parts.rend(); ++part) {
    other.take(*part);
    other.take(*part);
  }
  walk.team[0].solve();
  other.solve();
  for (std::size_t n = 0; n < other.size(); ++n)
    EXPECT_LT((other.poses()[n].inverse() * walk.team[0].poses()[n]).log().norm(), 1e-6);
}

TEST(KnownTeam, WithoutTheOthersPartAnObservationIsOfNoUseYet) {
  Walk walk(2, true);
  walk.move(0, 1);
  walk.see(0, 1, 1);
  walk.team[0].solve();
  EXPECT_EQ(walk.team[0].weight(0), 0);
  walk.share_all(1);
  walk.team[0].solve();
  EXPECT_EQ(walk.team[0].weight(0), 1);
}

// c has seen b and knows y's part, in which y has seen b; nothing is known of b itself.
TEST(KnownTeam, IsInNoFrameToWhichOnlyANameLeads) {
  KnownTeam y("y", 0, SE2({5, 0}, 0), {}), c("c", 0, std::nullopt, {});
  y.move(1, SE2({1, 0}, 0), kSigma_m, kSigma_rad);
  y.see(1, "b", SE2({1, 0}, 0), kSigma_m, kSigma_rad, kNoAngles);
  c.move(1, SE2({1, 0}, 0), kSigma_m, kSigma_rad);
  c.see(1, "b", SE2({0, 1}, 0), kSigma_m, kSigma_rad, kNoAngles);
  ASSERT_TRUE(c.take(y.own_part(1)));
  c.solve();
  EXPECT_EQ(c.frame(), "c");
  EXPECT_EQ(c.team(), std::vector<std::string>{"c"});
  EXPECT_GT(c.latest().covariance(0, 0), 0);
}

TEST(KnownTeam, RobotsWithoutAStartAreInTheCommonFrameOnceOneWithAStartIsConnected) {
  Walk walk(2, true);
  KnownTeam c("c", 0, std::nullopt, {});
  c.move(1, SE2({1, 0}, 0), kSigma_m, kSigma_rad);
  walk.move(0, 1);
  c.see(1, "a", SE2({0, 1}, 0), kSigma_m, kSigma_rad, kNoAngles);
  walk.team[0].take(c.own_part(1));
  c.take(walk.team[0].own_part(1));
  c.solve();
  EXPECT_EQ(c.frame(), "");
  const SE2 expected = walk.team[0].poses().back() * SE2({0, 1}, 0).inverse();
  EXPECT_LT((expected.inverse() * c.poses().back()).log().norm(), 1e-6);
}

TEST(KnownTeam, RefusesPartsThatAreNotWellFormed) {
  Walk walk(2, true);
  walk.move(1, 1);
  walk.see(1, 0, 1);
  const SharedPart good = *walk.team[1].own_part(1);
  const auto refused = [&](auto change) {
    auto part = std::make_shared<SharedPart>(good);
    change(*part);
    KnownTeam fresh("a", 0, SE2(), {});
    return !fresh.take(part);
  };
  EXPECT_FALSE(refused([](SharedPart&) {}));
  EXPECT_TRUE(refused([](SharedPart& part) { part.nodes.clear(); }));
  EXPECT_TRUE(refused([](SharedPart& part) { part.nodes[1].number = 0; }));
  EXPECT_TRUE(refused([](SharedPart& part) { part.nodes[1].from_before.covariance(0, 0) = -1; }));
  EXPECT_TRUE(refused([](SharedPart& part) { part.observations[0].node = 7; }));
  EXPECT_TRUE(refused([](SharedPart& part) { part.observations[0].sigma_m = 0; }));
  EXPECT_TRUE(refused([](SharedPart& part) { part.observations[0].t_s = std::nan(""); }));
}

// As a caller may send all relative poses of a rendezvous at once.
TEST(KnownTeam, ObservationsAtOneTimeHaveEvidenceOfTheirOwn) {
  Walk walk(2, true);
  walk.move(0, 1);
  walk.move(1, 1);
  for (const double log_odds : {-2.0, 40.0})
    walk.team[0].see(1, "b", walk.truth[0].inverse() * walk.truth[1], kSigma_m, kSigma_rad, {log_odds, 1});
  walk.share_all(1);
  ASSERT_EQ(walk.team[1].unjudged().size(), 2U);
  walk.team[0].solve();
  EXPECT_GT(walk.team[0].weight(0), 0.9);
  EXPECT_LT(walk.team[0].weight(1), 0.1);
}

TEST(KnownTeam, APartHoldsNoMoreThanAMessage) {
  Walk walk(2, true);
  for (int t = 1; t <= 400; ++t) {
    walk.move(0, t);
    walk.see(0, 1, t);
  }
  const auto part = walk.team[0].own_part(400);
  EXPECT_LE(part->nodes.size(), 100U);
  EXPECT_EQ(part->nodes.front().number, 0U);
  EXPECT_EQ(part->nodes.back().number, 400U);
  EXPECT_LE(part->observations.size(), 150U);
  EXPECT_TRUE(is_well_formed(*part));
}

}  // namespace
}  // namespace radioslam
