#include "radioslam/closure/overlap/overlap_search.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <utility>
#include <vector>

#include "closure/overlap/overlap_worlds.hpp"
#include "radioslam/base/parallel.hpp"

namespace radioslam {
namespace {

template <class Pose>
class OverlapSearchOf : public testing::Test {};
TYPED_TEST_SUITE(OverlapSearchOf, test::PoseTypes);

struct Tally {
  std::uint64_t kept = 0, pairs = 0, evaluated = 0;
};

template <class Source>
void equals_exhaustive(const Source& source, const std::vector<OverlapSensor>& sensors,
                       const OverlapParams& params, Tally& tally) {
  const auto found = search_overlaps(source, sensors, params);
  const auto all = search_overlaps_exhaustively(source, sensors, params);
  EXPECT_EQ(found.candidates, all.candidates);
  EXPECT_EQ(found.counts.pairs, all.counts.pairs);
  EXPECT_EQ(found.counts.kept, found.candidates.size());
  tally.kept += found.counts.kept;
  tally.pairs += found.counts.pairs;
  tally.evaluated += found.counts.distances_evaluated;
}

template <class Pose>
void worlds_agree(const char* distance, bool with_cones, bool joint, double min_shared_view = 0) {
  Tally tally;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    test::WorldSize size{2 + seed % 2, 120, 1 + seed % 5};
    size.area_m = 40 + 60 * static_cast<double>(seed % 3);
    auto world = test::draw_world<Pose>(seed, size);
    if (with_cones)
      for (std::size_t r = 0; r < size.robots; ++r) world.sensors[r].view_rad = 0.8 + static_cast<double>(r);
    OverlapParams params;
    params.distance = distance;
    params.max_mahalanobis = seed % 2 == 0 ? 2 : 0.7;
    params.min_shared_view = min_shared_view;
    if (joint) {
      const auto source = JointCovariance<Pose>::compute(world.graph, world.robots, seed == 3 ? 1 : 1 << 24);
      ASSERT_TRUE(source.has_value());
      equals_exhaustive(*source, world.sensors, params, tally);
    } else {
      equals_exhaustive(LinkCovariance<Pose>(world.chains, world.links), world.sensors, params, tally);
    }
  }
  EXPECT_GT(tally.kept, 100U);
  EXPECT_LT(tally.kept, tally.pairs / 2);
  EXPECT_LT(tally.evaluated, tally.pairs);
}

TYPED_TEST(OverlapSearchOf, JointEqualsExhaustive) { worlds_agree<TypeParam>("minimum", false, true); }
TYPED_TEST(OverlapSearchOf, JointSeedEqualsExhaustive) { worlds_agree<TypeParam>("seed", false, true); }
TYPED_TEST(OverlapSearchOf, JointConesEqualExhaustive) { worlds_agree<TypeParam>("minimum", true, true); }
TYPED_TEST(OverlapSearchOf, LinkEqualsExhaustive) { worlds_agree<TypeParam>("minimum", false, false); }
TYPED_TEST(OverlapSearchOf, LinkSeedEqualsExhaustive) { worlds_agree<TypeParam>("seed", false, false); }
TYPED_TEST(OverlapSearchOf, LinkConesEqualExhaustive) { worlds_agree<TypeParam>("minimum", true, false); }
TYPED_TEST(OverlapSearchOf, JointSharedEqualsExhaustive) {
  worlds_agree<TypeParam>("minimum", false, true, 0.18);
}
TYPED_TEST(OverlapSearchOf, JointSharedConesEqualExhaustive) {
  worlds_agree<TypeParam>("minimum", true, true, 0.18);
}
TYPED_TEST(OverlapSearchOf, LinkSharedSeedEqualsExhaustive) {
  worlds_agree<TypeParam>("seed", false, false, 0.18);
}
TYPED_TEST(OverlapSearchOf, LinkSharedConesEqualExhaustive) {
  worlds_agree<TypeParam>("minimum", true, false, 0.18);
}

TYPED_TEST(OverlapSearchOf, SameBytesForAnyNumberOfThreads) {
  const auto world = test::draw_world<TypeParam>(1, {3, 200, 4});
  const auto source = JointCovariance<TypeParam>::compute(world.graph, world.robots);
  ASSERT_TRUE(source.has_value());
  set_thread_count(1);
  const auto one = search_overlaps(*source, world.sensors, {});
  set_thread_count(7);
  const auto seven = search_overlaps(*source, world.sensors, {});
  set_thread_count(0);
  EXPECT_EQ(one.candidates, seven.candidates);
  EXPECT_EQ(one.counts.distances_evaluated, seven.counts.distances_evaluated);
  EXPECT_EQ(one.counts.boxes_visited, seven.counts.boxes_visited);
}

TYPED_TEST(OverlapSearchOf, RunsOfAnyLengthGiveTheSame) {
  auto world = test::draw_world<TypeParam>(2, {3, 200, 6});
  world.graph.relative_poses.erase(world.graph.relative_poses.begin() +
                                   70);  // the first robot's chain breaks
  const auto whole = JointCovariance<TypeParam>::compute(world.graph, world.robots);
  ASSERT_TRUE(whole.has_value());
  ASSERT_EQ(whole->team().runs(0, whole->poses(0)).size(), 1U);
  const auto expected = search_overlaps(*whole, world.sensors, {});
  ASSERT_GT(expected.candidates.size(), 50U);
  for (const std::size_t dense_scalars : {1U, 10000U}) {
    const auto source = JointCovariance<TypeParam>::compute(world.graph, world.robots, dense_scalars);
    ASSERT_GT(source->team().runs(0, source->poses(0)).size(), 1U);
    const auto found = search_overlaps(*source, world.sensors, {});
    ASSERT_EQ(found.candidates.size(), expected.candidates.size()) << dense_scalars;
    EXPECT_EQ(found.counts.pairs, expected.counts.pairs);
    for (std::size_t k = 0; k < found.candidates.size(); ++k) {
      EXPECT_EQ(found.candidates[k].robot_b, expected.candidates[k].robot_b);
      EXPECT_EQ(found.candidates[k].pose_a, expected.candidates[k].pose_a);
      EXPECT_EQ(found.candidates[k].pose_b, expected.candidates[k].pose_b);
      EXPECT_NEAR(found.candidates[k].mahalanobis, expected.candidates[k].mahalanobis, 1e-6);
    }
  }
}

TEST(OverlapSearchTest, RobotsWithoutTiesHaveNoCandidates) {
  const auto world = test::draw_world<SE2>(1, {2, 30, 0}, false);
  const auto by_link = search_overlaps(LinkCovariance<SE2>(world.chains, {}), world.sensors, {});
  EXPECT_TRUE(by_link.candidates.empty());
  EXPECT_EQ(by_link.counts.pairs, 900U);
  const auto joint = JointCovariance<SE2>::compute(world.graph, world.robots);
  ASSERT_TRUE(joint.has_value());
  EXPECT_TRUE(search_overlaps(*joint, world.sensors, {}).candidates.empty());
  EXPECT_TRUE(search_overlaps_exhaustively(*joint, world.sensors, {}).candidates.empty());
}

/// Two robots on parallel paths, exact except for the link's bearing: overlaps are known analytically.
TEST(OverlapSearchTest, KnownTeam) {
  KeyframeOdometry<SE2> a, b;
  for (int k = 0; k < 11; ++k) {
    a.poses.push_back(SE2({10.0 * k, 0}, 0));
    b.poses.push_back(SE2({10.0 * k, 0}, 0));
  }
  a.cov_steps.assign(10, SE2::Jacobian::Zero());
  b.cov_steps = a.cov_steps;
  const OverlapLink<SE2> link{0, 0, 1, 0, SE2({0, 15}, 0), Eigen::Vector3d(0, 1, 0).asDiagonal()};
  const LinkCovariance<SE2> source({a, b}, {link});
  EXPECT_TRUE(search_overlaps(source, {{7.0}, {5.0}}, {2}).candidates.empty());
  const auto found = search_overlaps(source, {{7.0}, {5.0}}, {3.01});
  ASSERT_EQ(found.candidates.size(), 11U) << "3 m are missing, at 1 m a standard deviation";
  for (std::uint32_t k = 0; k < 11; ++k) {
    EXPECT_EQ(found.candidates[k].pose_a, k);
    EXPECT_EQ(found.candidates[k].pose_b, k);
    EXPECT_NEAR(found.candidates[k].distance_m, 15, 1e-9);
    EXPECT_NEAR(found.candidates[k].mahalanobis, 3, 1e-9);
  }
  EXPECT_EQ(search_overlaps(source, {{8.0}, {7.0}}, {2}).candidates.size(), 11U) << "inside the ball";
}

/// One pose of each robot, exactly known.
LinkCovariance<SE2> two_poses(double distance_m) {
  const KeyframeOdometry<SE2> chain{{SE2()}, {}, {}};
  return {{chain, chain}, {{0, 0, 1, 0, SE2({distance_m, 0}, 0), SE2::Jacobian::Zero()}}};
}

TEST(OverlapSearchTest, TwoScannersOf30mShareEnoughUpTo35m) {
  const OverlapParams published{.min_shared_view = 0.18};
  EXPECT_EQ(search_overlaps(two_poses(34.8), {{30}, {30}}, published).candidates.size(), 1U);
  EXPECT_EQ(search_overlaps(two_poses(35), {{30}, {30}}, published).candidates.size(), 0U);
  EXPECT_EQ(search_overlaps(two_poses(35), {{30}, {30}}, {}).candidates.size(), 1U) << "they touch";
}

TEST(OverlapSearchTest, ViewsThatNeverShareEnoughHaveNoCandidates) {
  const auto source = two_poses(0);
  for (const std::vector<OverlapSensor>& sensors :
       {std::vector<OverlapSensor>{{30}, {12}}, std::vector<OverlapSensor>{{30, 6}, {30, 1}}}) {
    const OverlapParams params{.max_mahalanobis = 1000, .min_shared_view = 0.18};
    const auto found = search_overlaps(source, sensors, params);
    EXPECT_TRUE(found.candidates.empty());
    EXPECT_EQ(found.counts.pairs, 1U);
    EXPECT_TRUE(search_overlaps_exhaustively(source, sensors, params).candidates.empty());
    EXPECT_EQ(search_overlaps(source, sensors, {}).candidates.size(), 1U) << "but they touch";
  }
}

/// Pairs of poses whose views share at least `min_shared_view` at the poses themselves.
std::vector<std::pair<std::uint32_t, std::uint32_t>> sharing_pairs(const test::OverlapWorld<SE2>& world,
                                                                   double min_shared_view) {
  const auto view = [&](std::size_t robot, std::size_t k) {
    const SE2& pose = world.chains[robot].poses[k];
    const OverlapSensor& sensor = world.sensors[robot];
    return ViewSector{pose.translation(), pose.angle(), sensor.view_rad / 2, sensor.range_m};
  };
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (std::uint32_t k = 0; k < world.chains[0].poses.size(); ++k)
    for (std::uint32_t l = 0; l < world.chains[1].poses.size(); ++l)
      if (shared_view(view(0, k), view(1, l)) >= min_shared_view) pairs.emplace_back(k, l);
  return pairs;
}

TEST(OverlapSearchTest, OfExactPosesFindsAllPairsThatShareEnoughAndNoOthers) {
  for (const double view_rad : {2 * std::numbers::pi, 4.0, 1.5}) {
    auto world = test::draw_world<SE2>(5, {2, 150, 1});
    world.sensors = {{9, view_rad}, {8, view_rad}};
    for (auto& chain : world.chains) chain.cov_steps.assign(149, SE2::Jacobian::Zero());
    const SE2 T_a_b = world.chains[0].poses[40].inverse() * world.chains[1].poses[90];
    const LinkCovariance<SE2> source(world.chains, {{0, 40, 1, 90, T_a_b, SE2::Jacobian::Zero()}});
    const OverlapParams params{.min_shared_view = 0.18};
    std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
    for (const auto& pair : search_overlaps(source, world.sensors, params).candidates)
      found.emplace_back(pair.pose_a, pair.pose_b);
    EXPECT_EQ(found, sharing_pairs(world, 0.18)) << view_rad;
    EXPECT_GT(found.size(), 10U) << view_rad;
  }
}

}  // namespace
}  // namespace radioslam
