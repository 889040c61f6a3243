#include "radioslam/closure/overlap/overlap_exchange.hpp"

#include <gtest/gtest.h>

#include "closure/overlap/overlap_worlds.hpp"
#include "radioslam/closure/overlap/overlap_search.hpp"

namespace radioslam {
namespace {

template <class Pose>
class OverlapExchangeOf : public testing::Test {};
TYPED_TEST_SUITE(OverlapExchangeOf, test::PoseTypes);

template <class Source>
std::uint64_t equals_central(const Source& source, const std::vector<OverlapSensor>& sensors,
                             const OverlapParams& params = {}) {
  const auto central = search_overlaps(source, sensors, params);
  const auto exchange = exchange_overlaps(source, 0, 1, sensors, params);
  EXPECT_EQ(exchange.found.candidates, central.candidates);
  EXPECT_EQ(exchange.found.counts.pairs, central.counts.pairs);
  EXPECT_EQ(exchange.cost.final_message, 4 + 24 * central.counts.kept);
  return central.counts.kept;
}

TYPED_TEST(OverlapExchangeOf, FindsWhatTheCentralSearchFinds) {
  std::uint64_t kept = 0;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    auto world = test::draw_world<TypeParam>(seed, {2, 150, 1 + seed});
    if (seed % 2 == 1) world.sensors[0].view_rad = 1.5;
    kept += equals_central(LinkCovariance<TypeParam>(world.chains, world.links), world.sensors);
    const auto joint = JointCovariance<TypeParam>::compute(world.graph, world.robots);
    ASSERT_TRUE(joint.has_value());
    kept += equals_central(*joint, world.sensors);
    equals_central(*joint, world.sensors, {.min_shared_view = 0.18});
  }
  EXPECT_GT(kept, 1000U);
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
  const auto exchange = exchange_overlaps(LinkCovariance<SE2>({a, b}, {link}), 0, 1, {{10}, {10}}, {});
  EXPECT_GT(exchange.found.counts.kept, 1000U);
  EXPECT_EQ(exchange.cost.all_poses, 4 + 1000U * (10 + 1) * 8 - 1000U * 4);
  EXPECT_LT(exchange.cost.requests + exchange.cost.answers, exchange.cost.all_poses / 4);
  EXPECT_LT(exchange.cost.rounds, 16);
}

TEST(OverlapExchangeTest, MalformedMessagesAreRefused) {
  const auto world = test::draw_world<SE2>(1, {2, 50, 3});
  const LinkCovariance<SE2> source(world.chains, world.links);
  const OverlapServer<LinkCovariance<SE2>> answerer(source, 1);
  OverlapClient<LinkCovariance<SE2>> asker(source, 0, 1, {2, OverlapDistance::kMinimum, {10}, {10}});
  auto hello = answerer.hello();
  hello.pop_back();
  EXPECT_THROW(asker.receive_hello(hello), std::invalid_argument);
  EXPECT_THROW(answerer.answer(OverlapMessage(7, '\0')), std::invalid_argument);
  EXPECT_THROW(answerer.answer(OverlapMessage(12, '\1')), std::invalid_argument);
}

/// A request that names a box very often would make its answer as many times as long.
TEST(OverlapExchangeTest, BoxesAreSentOnce) {
  const auto world = test::draw_world<SE2>(1, {2, 50, 3});
  const LinkCovariance<SE2> source(world.chains, world.links);
  const OverlapServer<LinkCovariance<SE2>> answerer(source, 1);
  const auto request = [](std::vector<std::uint32_t> open, std::vector<std::uint32_t> send) {
    OverlapFieldWriter out;
    for (const auto& list : {open, send}) {
      out(static_cast<std::uint32_t>(list.size()));
      for (const std::uint32_t box : list) out(box);
    }
    return out.take();
  };
  EXPECT_FALSE(answerer.answer(request({0, 1}, {0})).empty());
  EXPECT_THROW(answerer.answer(request({0, 0}, {})), std::invalid_argument);
  EXPECT_THROW(answerer.answer(request({}, {0, 0})), std::invalid_argument);
  EXPECT_THROW(answerer.answer(request({}, {0, 1})), std::invalid_argument) << "box 1 is half of box 0";
}

/// What a robot claims of its boxes must fit: intervals in order, halves of what was opened, as many roots as
/// it has pieces.
TEST(OverlapExchangeTest, BoxesThatDoNotFitAreRefused) {
  const auto world = test::draw_world<SE2>(1, {2, 50, 3});
  const LinkCovariance<SE2> source(world.chains, world.links);
  const OverlapServer<LinkCovariance<SE2>> answerer(source, 1);
  const auto receive = [&](std::size_t at, char byte) {
    OverlapClient<LinkCovariance<SE2>> asker(source, 0, 1, {2, OverlapDistance::kMinimum, {10}, {10}});
    auto hello = answerer.hello();
    hello[at] = byte;
    asker.receive_hello(hello);
  };
  EXPECT_NO_THROW(receive(8, 0));
  EXPECT_THROW(receive(0, 100), std::invalid_argument) << "roots";
  EXPECT_THROW(receive(12, 0), std::invalid_argument) << "the end of the first box";
  EXPECT_THROW(receive(16, 0), std::invalid_argument) << "its middle";
}

}  // namespace
}  // namespace radioslam
