#include "radioslam/closure/overlap/overlap_exchange.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "closure/overlap/overlap_worlds.hpp"
#include "radioslam/closure/overlap/overlap_search.hpp"

namespace radioslam {
namespace {

template <class Pose>
class OverlapExchangeOf : public testing::Test {};
TYPED_TEST_SUITE(OverlapExchangeOf, test::PoseTypes);

template <class Source>
using PartyOf = OverlapParty<typename Source::Poses, typename Source::Team>;

// A party is made of its own robot's poses and bytes: of the whole estimate it cannot be made.
static_assert(
    !std::is_constructible_v<PartyOf<LinkCovariance<SE2>>, std::uint32_t, const LinkCovariance<SE2>&,
                             std::vector<std::string>, OverlapSensor, OverlapParams>);
static_assert(
    !std::is_constructible_v<PartyOf<JointCovariance<SE2>>, std::uint32_t, const JointCovariance<SE2>&,
                             std::vector<std::string>, OverlapSensor, OverlapParams>);

struct Exchange {
  OverlapCandidates found;
  OverlapTraffic traffic;
};

template <class Source>
Exchange exchange(const Source& source, const std::vector<OverlapSensor>& sensors,
                  const OverlapParams& params = {}) {
  Exchange result;
  const TeamOverlapExchange<Source> search(source, sensors, params, result.traffic);
  for (std::uint32_t a = 0; a < source.robots(); ++a)
    result.found.counts += search.search(a, [&](std::vector<OverlapCandidate> found) {
      auto& all = result.found.candidates;
      all.insert(all.end(), found.begin(), found.end());
    });
  return result;
}

std::uint64_t sum(const OverlapTraffic& traffic, std::size_t robot) {
  return std::accumulate(traffic.bytes[robot].begin(), traffic.bytes[robot].end(), std::uint64_t{0});
}

template <class Source>
std::uint64_t equals_central(const Source& source, const std::vector<OverlapSensor>& sensors,
                             const OverlapParams& params = {}) {
  const auto central = search_overlaps(source, sensors, params);
  const auto distributed = exchange(source, sensors, params);
  EXPECT_EQ(distributed.found.candidates, central.candidates);
  EXPECT_EQ(distributed.found.counts.pairs, central.counts.pairs);
  EXPECT_EQ(distributed.found.counts.kept, central.counts.kept);
  EXPECT_EQ(distributed.found.counts.distances_evaluated, central.counts.distances_evaluated);
  return central.counts.kept;
}

TYPED_TEST(OverlapExchangeOf, FindsWhatTheCentralSearchFinds) {
  std::uint64_t kept = 0;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    auto world = test::draw_world<TypeParam>(seed, {2 + seed % 4, 150, 1 + seed});
    if (seed % 2 == 1) world.sensors[0].view_rad = 1.5;
    kept += equals_central(LinkCovariance<TypeParam>(world.chains, world.links), world.sensors);
    const auto joint = JointCovariance<TypeParam>::compute(world.graph, world.robots);
    ASSERT_TRUE(joint.has_value());
    kept += equals_central(*joint, world.sensors);
    equals_central(*joint, world.sensors, {.min_shared_view = 0.18});
  }
  EXPECT_GT(kept, 1000U);
}

/// Trajectories in several pieces, a robot that no link connects, and one without poses.
TYPED_TEST(OverlapExchangeOf, FindsItForBrokenTrajectories) {
  auto world = test::draw_world<TypeParam>(6, {3, 60, 4});
  auto& odometry = world.graph.relative_poses;
  odometry[10].information.setZero();
  odometry.erase(odometry.begin() + 100);
  world.robots.emplace_back();
  world.sensors.push_back({10});
  const auto joint = JointCovariance<TypeParam>::compute(world.graph, world.robots);
  ASSERT_TRUE(joint.has_value());
  EXPECT_GT(joint->poses(0).pieces().size(), 1U);
  EXPECT_GT(equals_central(*joint, world.sensors), 0U);
  std::erase_if(world.links, [](const auto& link) { return link.robot_a == 2 || link.robot_b == 2; });
  EXPECT_GT(equals_central(LinkCovariance<TypeParam>(world.chains, world.links), {{20}, {20}, {20}}), 0U);
}

/// Two straight paths that cross at a right angle: poses far from the crossing need not be sent.
TEST(OverlapExchangeTest, CostsAFractionOfSendingEveryPose) {
  KeyframeOdometry<SE2> a, b;
  for (int k = 0; k < 1000; ++k) {
    a.poses.push_back(SE2({k - 500.0, 0}, 0));
    b.poses.push_back(SE2({0, k - 500.0}, 1.5707963));
  }
  a.cov_steps.assign(999, Eigen::Vector3d(4e-4, 4e-4, 1e-6).asDiagonal());
  b.cov_steps = a.cov_steps;
  const OverlapLink<SE2> link{
      0, 500, 1, 500, SE2({0, 0}, 1.5707963), Eigen::Vector3d(0.25, 0.25, 1e-3).asDiagonal()};
  const auto result = exchange(LinkCovariance<SE2>({a, b}, {link}), {{10}, {10}});
  EXPECT_GT(result.found.counts.kept, 1000U);
  constexpr std::size_t kPoseBytes = 10 * 8;
  EXPECT_LT(sum(result.traffic, 1), 1000U * kPoseBytes / 4);
  EXPECT_LT(sum(result.traffic, 0), 1000U * kPoseBytes / 4);
  EXPECT_LT(result.traffic.rounds, 16U);
}

/// Two parties whose messages can be looked at on their way.
template <class Source>
struct Parties {
  explicit Parties(const Source& source) : first(make(source, 0)), second(make(source, 1)) {}

  static PartyOf<Source> make(const Source& source, std::uint32_t robot) {
    std::vector<std::string> shares(2);
    shares[1 - robot] = source.share(robot, 1 - robot);
    return {robot, source.poses(robot), shares, {20}, {}};
  }
  PartyOf<Source>& party(std::uint32_t robot) { return robot == 0 ? first : second; }

  /// Delivers everything, after `look` has had each message.
  template <class Look>
  void run(const Look& look) {
    std::vector<OverlapMessage> on_the_way = first.begin();
    for (auto& message : second.begin()) on_the_way.push_back(message);
    while (!on_the_way.empty()) {
      std::vector<OverlapMessage> next;
      for (const OverlapMessage& message : on_the_way) {
        look(message);
        auto answers = party(message.to).hear(message.bytes);
        ASSERT_TRUE(answers.has_value());
        next.insert(next.end(), answers->begin(), answers->end());
      }
      on_the_way = next;
    }
  }

  PartyOf<Source> first, second;
};

TYPED_TEST(OverlapExchangeOf, BytesAreThoseOfTheMessagesAndBothKnowThePairs) {
  const auto world = test::draw_world<TypeParam>(1, {2, 80, 3});
  const auto both = [](const auto& source) {
    Parties parties(source);
    OverlapTraffic counted;
    counted.bytes.resize(2);
    parties.run([&](const OverlapMessage& message) {
      counted.bytes[1 - message.to][static_cast<std::size_t>(message.kind)] += message.bytes.size();
    });
    const auto result = exchange(source, {{20}, {20}});
    EXPECT_EQ(counted.bytes, result.traffic.bytes);
    ASSERT_TRUE(parties.first.is_finished() && parties.second.is_finished());
    const auto& found = parties.first.found(1).candidates;
    EXPECT_GT(found.size(), 0U);
    EXPECT_EQ(found, result.found.candidates);
    EXPECT_EQ(parties.second.received(0), runs_of(found));
  };
  both(LinkCovariance<TypeParam>(world.chains, world.links));
  const auto joint = JointCovariance<TypeParam>::compute(world.graph, world.robots);
  ASSERT_TRUE(joint.has_value());
  both(*joint);
}

/// Every message cut anywhere, longer than it is, from someone else or again: refused, and as if it had never
/// come.
TYPED_TEST(OverlapExchangeOf, DamagedMessagesAreRefusedAndChangeNothing) {
  const auto world = test::draw_world<TypeParam>(1, {2, 40, 2});
  const auto damage = [](const auto& source) {
    Parties parties(source);
    parties.run([&](const OverlapMessage& message) {
      auto& party = parties.party(message.to);
      for (std::size_t size = 0; size < message.bytes.size(); size += size < 16 ? 1 : 7)
        ASSERT_FALSE(party.hear(message.bytes.substr(0, size)).has_value()) << size;
      EXPECT_FALSE(party.hear(message.bytes + '\0').has_value());
      for (std::size_t at = 0; at < 6; ++at) {  // marks, version, dimension, kind, sender
        std::string other = message.bytes;
        other[at] = static_cast<char>(other[at] + 64);
        EXPECT_FALSE(party.hear(other).has_value()) << at;
      }
    });
    EXPECT_EQ(parties.first.found(1).candidates, exchange(source, {{20}, {20}}).found.candidates);
    for (auto* party : {&parties.first, &parties.second})
      for (const auto& message : parties.party(party == &parties.first ? 1U : 0U).begin())
        EXPECT_FALSE(party->hear(message.bytes).has_value()) << "it has come already";
  };
  damage(LinkCovariance<TypeParam>(world.chains, world.links));
  const auto joint = JointCovariance<TypeParam>::compute(world.graph, world.robots);
  ASSERT_TRUE(joint.has_value());
  damage(*joint);
}

/// Any byte may be wrong: the message is refused, or what it says is as good as another.
TYPED_TEST(OverlapExchangeOf, WrongBytesDoNoHarm) {
  const auto world = test::draw_world<TypeParam>(1, {2, 40, 2});
  Rng rng(7);
  std::size_t refused = 0;
  const auto corrupt = [&](const auto& source) {
    for (int trial = 0; trial < 60; ++trial) {
      Parties parties(source);
      std::vector<OverlapMessage> on_the_way = parties.first.begin();
      for (auto& message : parties.second.begin()) on_the_way.push_back(message);
      while (!on_the_way.empty()) {
        std::vector<OverlapMessage> next;
        for (OverlapMessage& message : on_the_way) {
          if (rng.below(4) == 0)
            message.bytes[rng.below(message.bytes.size())] = static_cast<char>(rng.below(256));
          const auto answers = parties.party(message.to).hear(message.bytes);
          refused += answers ? 0U : 1U;
          if (answers) next.insert(next.end(), answers->begin(), answers->end());
        }
        on_the_way = next;
      }
    }
  };
  corrupt(LinkCovariance<TypeParam>(world.chains, world.links));
  const auto joint = JointCovariance<TypeParam>::compute(world.graph, world.robots);
  ASSERT_TRUE(joint.has_value());
  corrupt(*joint);
  EXPECT_GT(refused, 10U);
}

/// A request that names a box very often would make its answer as many times as long.
TEST(OverlapExchangeTest, BoxesAreAskedForOnce) {
  const auto asks = [](std::vector<std::uint32_t> open, std::vector<std::uint32_t> send) {
    return read_request(write_request({std::move(open), std::move(send)})).has_value();
  };
  EXPECT_TRUE(asks({0, 1}, {0}));
  EXPECT_TRUE(asks({}, {}));
  EXPECT_FALSE(asks({0, 0}, {}));
  EXPECT_FALSE(asks({}, {3, 2}));
}

TEST(OverlapExchangeTest, RunsOfPairsHoldEveryPairOnce) {
  const std::vector<OverlapCandidate> pairs{{0, 1, 3, 7}, {0, 1, 3, 8}, {0, 1, 3, 10}, {0, 1, 4, 11}};
  EXPECT_EQ(runs_of(pairs), (std::vector<PairRun>{{3, 7, 9}, {3, 10, 11}, {4, 11, 12}}));
  EXPECT_TRUE(runs_of({}).empty());
}

}  // namespace
}  // namespace radioslam
