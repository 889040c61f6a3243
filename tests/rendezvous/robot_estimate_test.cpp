#include "radioslam/rendezvous/robot_estimate.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "radioslam/base/random.hpp"
#include "radioslam/graph/initial_values.hpp"
#include "radioslam/graph/marginals.hpp"
#include "radioslam/graph/optimizer.hpp"

namespace radioslam {
namespace {

constexpr double kSigma_m = 0.05, kSigma_rad = 0.02;

SE2 with_noise(const SE2& pose, Rng& rng) {
  return pose * SE2::exp({rng.normal(0, kSigma_m), rng.normal(0, kSigma_m), rng.normal(0, kSigma_rad)});
}

constexpr std::size_t kNoEnd = std::numeric_limits<std::size_t>::max();

/// All records that one robot knows.
std::string records_of(const RobotEstimate& from) {
  std::string bytes;
  for (const auto& [name, log] : from.logs().all()) bytes += from.logs().records(name, 0, kNoEnd).first;
  return bytes;
}

/// Tells a robot all that another knows.
void share(RobotEstimate& from, RobotEstimate& to, double t_s) {
  from.logs().is_whole_until(Stamp::from_seconds(t_s));
  to.logs().is_whole_until(Stamp::from_seconds(t_s));
  to.logs().note(from.logs().versions(t_s));
  to.logs().accept(records_of(from));
}

/// Robots that walk circles side by side, see each other at times, and what a central graph knows of it.
struct Walk {
  std::vector<RobotEstimate> team;
  std::vector<SE2> truth;
  PoseGraph2 central;
  std::vector<std::vector<PoseId>> ids;
  Rng rng{7};

  explicit Walk(std::size_t robots, bool starts_known) {
    for (std::size_t k = 0; k < robots; ++k) {
      const SE2 start({3.0 * static_cast<double>(k), 0}, 0.3);
      team.emplace_back(name(k), 0, starts_known ? std::optional(start) : std::nullopt,
                        RobotEstimateParams{});
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
    team[i].see(t_s, name(j), measured, kSigma_m, kSigma_rad);
    factor(ids[i].back(), ids[j].back(), measured);
  }
  void share_all(double t_s) {
    for (auto& from : team)
      for (auto& to : team) share(from, to, t_s);
  }
};

void expect_same_as_central(Walk& walk, RobotEstimate::Odometry odometry, double tolerance) {
  initialise_from_spanning_tree(walk.central);
  optimize(walk.central, OptimizerParams{});
  const auto marginals = Marginals<SE2>::compute(walk.central);
  ASSERT_TRUE(marginals);
  for (std::size_t k = 0; k < walk.team.size(); ++k) {
    ASSERT_TRUE(walk.team[k].solve(odometry));
    const auto& poses = walk.team[k].poses();
    ASSERT_EQ(poses.size(), walk.ids[k].size());
    for (std::size_t n = 0; n < poses.size(); ++n)
      EXPECT_LT((walk.central.poses[walk.ids[k][n].index()].inverse() * poses[n]).log().norm(), tolerance);
    const SE2::Jacobian central = marginals->pose(walk.ids[k].back());
    EXPECT_LT((walk.team[k].latest().covariance - central).norm(), 0.05 * central.norm());
  }
}

TEST(RobotEstimate, EveryRobotThatKnowsAllRecordsHasTheCentralEstimateAndItsCovariance) {
  Walk walk(3, true);
  for (int t = 1; t <= 40; ++t) {
    for (std::size_t k = 0; k < 3; ++k) walk.move(k, t);
    if (t % 10 == 0) walk.see(0, 1, t);
    if (t % 13 == 0) walk.see(2, 1, t);
    if (t % 17 == 0) walk.see(1, 2, t);
  }
  walk.share_all(40);
  expect_same_as_central(walk, RobotEstimate::Odometry::kCondensed, 0.01);
  expect_same_as_central(walk, RobotEstimate::Odometry::kWhole, 1e-4);
}

TEST(RobotEstimate, RobotsWithoutStartsAgreeOnTheFrameOfTheFirst) {
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

TEST(RobotEstimate, RecordsMayComeTwiceAndInAnyOrder) {
  Walk walk(2, true);
  std::vector<std::string> pieces;
  for (int t = 1; t <= 30; ++t) {
    for (std::size_t k = 0; k < 2; ++k) walk.move(k, t);
    const std::uint64_t known = walk.team[1].own().records();
    if (t % 5 == 0) walk.see(1, 0, t);
    pieces.push_back(walk.team[1].logs().records("b", known > 3 ? known - 3 : 0, kNoEnd).first);
  }
  RobotEstimate in_order("a", 0, SE2({0, 0}, 0.3), {}), backwards = in_order;
  for (auto* team : {&in_order, &backwards})
    for (int t = 1; t <= 30; ++t) team->move(t, SE2({0.8, 0}, 0.15), kSigma_m, kSigma_rad);
  for (auto* team : {&in_order, &backwards}) team->logs().is_whole_until(Stamp::from_seconds(30));
  for (const auto& piece : pieces) in_order.logs().accept(piece);
  for (auto piece = pieces.rbegin(); piece != pieces.rend(); ++piece) {
    backwards.logs().accept(*piece);
    backwards.logs().accept(*piece);
  }
  in_order.solve();
  backwards.solve();
  EXPECT_EQ(in_order.team().size(), 2U);
  for (std::size_t n = 0; n < in_order.size(); ++n)
    EXPECT_LT((in_order.poses()[n].inverse() * backwards.poses()[n]).log().norm(), 1e-6);
}

TEST(RobotEstimate, RecordsArePassedOnAsTheyAre) {
  Walk walk(3, true);
  for (int t = 1; t <= 10; ++t)
    for (std::size_t k = 0; k < 3; ++k) walk.move(k, t);
  walk.see(0, 1, 10);
  walk.see(1, 2, 10);
  share(walk.team[0], walk.team[1], 10);
  share(walk.team[1], walk.team[2], 10);
  share(walk.team[2], walk.team[0], 10);
  EXPECT_EQ(records_of(walk.team[2]), records_of(walk.team[0]));
  for (auto& team : walk.team) team.solve();
  EXPECT_EQ(walk.team[2].team(), (std::vector<std::string>{"a", "b", "c"}));
  const auto where = walk.team[2].pose_of("a", Stamp::from_seconds(10));
  ASSERT_TRUE(where);
  EXPECT_LT((where->inverse() * walk.team[0].poses().back()).log().norm(), 1e-6);
}

TEST(RobotEstimate, WithoutTheOthersLogASightingIsOfNoUseYet) {
  Walk walk(2, true);
  walk.move(0, 1);
  walk.see(0, 1, 1);
  walk.team[0].solve();
  EXPECT_EQ(walk.team[0].weight(0), 0);
  walk.share_all(1);
  walk.team[0].solve();
  EXPECT_EQ(walk.team[0].weight(0), 1);
}

// c has seen b and knows y's log, in which y has seen b; nothing is known of b itself.
TEST(RobotEstimate, IsInNoFrameToWhichOnlyANameLeads) {
  RobotEstimate y("y", 0, SE2({5, 0}, 0), {}), c("c", 0, std::nullopt, {});
  y.move(1, SE2({1, 0}, 0), kSigma_m, kSigma_rad);
  y.see(1, "b", SE2({1, 0}, 0), kSigma_m, kSigma_rad);
  c.move(1, SE2({1, 0}, 0), kSigma_m, kSigma_rad);
  c.see(1, "b", SE2({0, 1}, 0), kSigma_m, kSigma_rad);
  share(y, c, 1);
  c.solve();
  EXPECT_EQ(c.frame(), "c");
  EXPECT_EQ(c.team(), std::vector<std::string>{"c"});
  EXPECT_GT(c.latest().covariance(0, 0), 0);
}

TEST(RobotEstimate, RobotsWithoutAStartAreInTheCommonFrameOnceOneWithAStartIsConnected) {
  Walk walk(2, true);
  RobotEstimate c("c", 0, std::nullopt, {});
  c.move(1, SE2({1, 0}, 0), kSigma_m, kSigma_rad);
  walk.move(0, 1);
  c.see(1, "a", SE2({0, 1}, 0), kSigma_m, kSigma_rad);
  share(walk.team[0], c, 1);
  c.solve();
  EXPECT_EQ(c.frame(), "");
  const SE2 expected = walk.team[0].poses().back() * SE2({0, 1}, 0).inverse();
  EXPECT_LT((expected.inverse() * c.poses().back()).log().norm(), 1e-5);  // of 32 bits
}

TEST(RobotEstimate, AnyBytesAreTakenOrLeft) {
  Walk walk(2, true);
  walk.move(1, 1);
  walk.see(1, 0, 1);
  const std::string good = records_of(walk.team[1]);
  for (std::size_t k = 0; k < good.size(); ++k) {
    std::string bytes = good;
    bytes[k] = static_cast<char>(bytes[k] ^ 0x55);
    RobotEstimate fresh("a", 0, SE2(), {});
    fresh.logs().accept(bytes.substr(0, k));
    fresh.logs().accept(bytes);
    fresh.solve();
    EXPECT_EQ(fresh.team(), std::vector<std::string>{"a"});
  }
}

/// Records that are valid each by itself, but do not belong together.
TEST(RobotEstimate, RecordsThatFitNoLogAreLeftOut) {
  RobotLogs other("b", Stamp{}, std::nullopt, {});
  const Sighting seen{7, "a", Stamp{}, SE2({1, 0}, 0)};
  other.say(keyframe_of(9, Stamp::from_seconds(1), SE2(), kSigma_m, kSigma_rad));
  other.say(keyframe_of(1, Stamp::from_seconds(-5), SE2(), kSigma_m, kSigma_rad));
  other.say(closure_of(7, seen));
  other.say(angles_of(7, Stamp{}, "a", {{0, 0.1, 0}}));
  RobotEstimate a("a", 0, SE2(), {});
  a.logs().is_whole_until(Stamp::from_seconds(9));
  a.logs().accept(other.records("b", 0, kNoEnd).first);
  ASSERT_EQ(a.logs().all().at("b").records(), 6U);
  EXPECT_EQ(a.logs().all().at("b").stamps().size(), 1U);
  EXPECT_TRUE(a.logs().all().at("b").sightings().empty());
  a.solve();
  EXPECT_EQ(a.team().size(), 1U);
}

TEST(RobotEstimate, OfARobotThatBeginsAgainTheNewLogCounts) {
  RobotEstimate a("a", 0, SE2(), {}), before("b", 0, SE2({9, 9}, 0), {}), again("b", 5, SE2({1, 0}, 0), {});
  before.see(0, "a", SE2({2, 2}, 0), kSigma_m, kSigma_rad);
  share(before, a, 1);
  again.see(5, "a", SE2({-1, 0}, 0), kSigma_m, kSigma_rad);
  share(again, a, 6);
  share(before, a, 7);
  a.solve();
  EXPECT_LT((*a.pose_of("b", Stamp::from_seconds(6))).translation().x(), 2);
  EXPECT_EQ(a.logs().versions(7).at("b").life, 5U);
}

// As a caller may send all relative poses of a rendezvous at once.
TEST(RobotEstimate, ObservationsAtOneTimeHaveEvidenceOfTheirOwn) {
  Walk walk(2, true);
  walk.move(0, 1);
  walk.move(1, 1);
  const SE2 T_a_b = walk.truth[0].inverse() * walk.truth[1];
  const double azimuth_rad = std::atan2(T_a_b.translation().y(), T_a_b.translation().x());
  for (const double turn_rad : {0.0, 1.0})
    walk.team[0].see(1, "b", SE2({0, 0}, turn_rad) * T_a_b, kSigma_m, kSigma_rad);
  walk.team[0].hear(1, "b", 1, {{azimuth_rad, 0.1, -50}});
  walk.share_all(1);
  walk.team[0].solve();
  EXPECT_GT(walk.team[0].weight(0), 0.9);
  EXPECT_LT(walk.team[0].weight(1), 0.3);
}

// What a robot heard counts for what others saw of it, whenever they learn of it.
TEST(RobotEstimate, AnglesOfEitherEndJudgeASighting) {
  Walk walk(2, true);
  walk.see(0, 1, 0);
  walk.share_all(1);
  walk.team[0].solve();
  EXPECT_EQ(walk.team[0].weight(0), 1);
  const Eigen::Vector2d offset = (walk.truth[1].inverse() * walk.truth[0]).translation();
  walk.team[1].hear(0, "a", 0, {{std::atan2(offset.y(), offset.x()) + 2, 0.1, -50}});
  walk.share_all(1);
  EXPECT_TRUE(walk.team[0].solve());
  EXPECT_LT(walk.team[0].weight(0), 0.3);
  EXPECT_FALSE(walk.team[0].solve());
}

TEST(RobotEstimate, UsesNoMorePosesOfOthersThanItMay) {
  Walk walk(2, true);
  for (int t = 1; t <= 500; ++t) {
    walk.move(0, t);
    walk.see(0, 1, t);
  }
  walk.share_all(500);
  ASSERT_TRUE(walk.team[1].solve());
  EXPECT_TRUE(walk.team[1].pose_of("a", Stamp::from_seconds(500)));
  EXPECT_FALSE(walk.team[1].pose_of("a", Stamp::from_seconds(300)));
  EXPECT_EQ(walk.team[0].weight(0), 0);
  walk.team[0].solve(RobotEstimate::Odometry::kWhole);
  EXPECT_EQ(walk.team[0].weight(0), 1);
  const auto [bytes, next] = walk.team[0].logs().records("a", 0, 38000);
  EXPECT_LT(bytes.size(), 40000U);
  EXPECT_LT(next, walk.team[0].own().records());
}

}  // namespace
}  // namespace radioslam
