#include <gtest/gtest.h>

#include "closure/overlap/overlap_worlds.hpp"
#include "radioslam/graph/marginals.hpp"

namespace radioslam {
namespace {

template <class Pose>
class OverlapJointOf : public testing::Test {};
TYPED_TEST_SUITE(OverlapJointOf, test::PoseTypes);

template <class Pose>
void equals_marginals(const PoseGraph<Pose>& graph, const std::vector<ChainOfPoses>& robots,
                      double precision = 1e-7) {
  const auto joint = JointCovariance<Pose>::compute(graph, robots);
  const auto marginals = Marginals<Pose>::compute(graph);
  ASSERT_TRUE(joint.has_value() && marginals.has_value());
  const auto id = [&](std::size_t r, std::size_t k) {
    return robots[r].poses[robots[r].searched.empty() ? k : robots[r].searched[k]];
  };
  for (std::size_t k = 0; k < joint->poses(0).records().size(); k += 5)
    for (std::size_t l = 0; l < joint->poses(1).records().size(); l += 7) {
      const auto expected = marginals->relative_pose(id(0, k), id(1, l));
      EXPECT_LT((joint->relative_pose(0, k, 1, l) - expected).norm(), precision * expected.norm())
          << k << " " << l;
    }
}

test::WorldSize small() { return {2, 60, 3}; }

TYPED_TEST(OverlapJointOf, EveryPairEqualsTheMarginals) {
  const auto world = test::draw_world<TypeParam>(1, small());
  equals_marginals(world.graph, world.robots);
}

TYPED_TEST(OverlapJointOf, FarFromTheOriginToo) {
  auto size = small();
  size.origin_m = 1e5;
  const auto world = test::draw_world<TypeParam>(2, size);
  equals_marginals(world.graph, world.robots, 1e-5);
}

TYPED_TEST(OverlapJointOf, G2oChartPriorsAndSearchedPoses) {
  auto world = test::draw_world<TypeParam>(4, small());
  world.graph.chart = PoseChart::kG2o;
  test::Drawing<TypeParam> draw(5);
  world.graph.pose_priors.push_back({PoseId(20), world.graph.poses[20] * draw.pose(0.1, 0.01)});
  world.graph.positions.push_back({{PoseId(40), {}, draw.point(0.1)}, world.graph.poses[40].translation()});
  for (std::size_t k = 0; k < 60; k += 1 + k % 3) world.robots[0].searched.push_back(k);
  equals_marginals(world.graph, world.robots);
}

/// A missing step, one without information, a duplicate factor, a change of drift, a robust step.
TYPED_TEST(OverlapJointOf, BrokenAndMendedChains) {
  auto world = test::draw_world<TypeParam>(6, {2, 60, 12});
  auto& odometry = world.graph.relative_poses;
  odometry[10].information.setZero();
  odometry.push_back(odometry[20]);
  odometry[30].loss = {LossKind::kHuber, 0.1};
  world.graph.drifts.push_back(Drift::Zero());
  world.graph.drift_priors.push_back({DriftId(2), Drift::Zero(), 1e4 * Eigen::Matrix2d::Identity()});
  for (std::size_t k = 35; k < 45; ++k) odometry[k].drift = DriftId(2);
  odometry.erase(odometry.begin() + 50);
  equals_marginals(world.graph, world.robots);
  const auto joint = JointCovariance<TypeParam>::compute(world.graph, world.robots);
  ASSERT_TRUE(joint.has_value());
  std::vector<std::size_t> begins;
  for (const auto& piece : joint->poses(0).pieces()) begins.push_back(piece.begin);
  EXPECT_EQ(begins, (std::vector<std::size_t>{0, 11, 35, 45, 51}));
  EXPECT_EQ(joint->poses(0).records().size(), 60U);
}

TYPED_TEST(OverlapJointOf, UnconnectedRobotsAreNotJoined) {
  auto world = test::draw_world<TypeParam>(7, {2, 20, 0}, false);
  const auto joint = JointCovariance<TypeParam>::compute(world.graph, world.robots);
  ASSERT_TRUE(joint.has_value());
  EXPECT_NE(joint->poses(0).component(0), joint->poses(1).component(0));
}

TYPED_TEST(OverlapJointOf, NothingWhenSomethingIsNotObserved) {
  auto world = test::draw_world<TypeParam>(8, {2, 20, 2});
  world.graph.drift_priors.clear();
  for (auto& factor : world.graph.relative_poses) factor.drift_jacobian.setZero();
  EXPECT_FALSE(JointCovariance<TypeParam>::compute(world.graph, world.robots).has_value());
}

}  // namespace
}  // namespace radioslam
