// Which stamps of an odometry become poses of the joint graph.
#include "radioslam/joint/robot_nodes.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

/// A sample each second, 0.4 m further along x: keyframes (1 m) at 0, 3, 6, 9 s and at the last sample, 10 s.
Trajectory<SE3> slow_drive() {
  std::vector<StampedPose<SE3>> rows;
  for (int k = 0; k <= 10; ++k)
    rows.push_back(
        {Stamp::from_seconds(k), SE3(Eigen::Vector3d(0.4 * k, 0, 0), Eigen::Quaterniond::Identity())});
  return Trajectory<SE3>(std::move(rows));
}

std::vector<Stamp> stamps(const std::vector<double>& seconds) {
  std::vector<Stamp> result;
  for (const double s : seconds) result.push_back(Stamp::from_seconds(s));
  return result;
}

TEST(SelectNodes, WithoutLinksAreTheKeyframes) {
  const auto nodes = select_nodes(slow_drive(), {}, {});
  EXPECT_EQ(nodes.stamps, stamps({0, 3, 6, 9, 10}));
  EXPECT_EQ(nodes.keyframes, (std::vector<std::size_t>{0, 1, 2, 3, 4}));
  EXPECT_EQ(nodes.rows, (std::vector<std::size_t>{0, 3, 6, 9, 10}));
  EXPECT_EQ(nodes.odometry.size(), 11U);
}

TEST(SelectNodes, LinksAddNodesInBetween) {
  const auto nodes = select_nodes(slow_drive(), stamps({7.5, 4, 7.5, 6}), {});
  EXPECT_EQ(nodes.stamps, stamps({0, 3, 4, 6, 7.5, 9, 10})) << "in order, none twice";
  EXPECT_EQ(nodes.keyframes, (std::vector<std::size_t>{0, 1, 3, 5, 6})) << "a link makes no keyframe";
  EXPECT_EQ(nodes.odometry.size(), 12U) << "only 7.5 s had no sample";
  ASSERT_EQ(nodes.rows.size(), nodes.stamps.size());
  for (std::size_t n = 0; n < nodes.rows.size(); ++n) {
    const auto& [stamp, pose] = nodes.odometry[nodes.rows[n]];
    EXPECT_EQ(stamp, nodes.stamps[n]);
    EXPECT_NEAR(pose.translation().x(), 0.4 * stamp.seconds(), 1e-9);
  }
}

TEST(SelectNodes, StampsThatTheOdometryDoesNotCoverAreIgnored) {
  const auto nodes = select_nodes(slow_drive(), stamps({-0.1, 10.1, 10}), {});
  EXPECT_EQ(nodes.stamps, stamps({0, 3, 6, 9, 10}));
}

TEST(RobotNodes, AreFoundByTheirStamp) {
  const auto nodes = select_nodes(slow_drive(), stamps({7.5}), {});
  EXPECT_EQ(nodes.node_at(Stamp::from_seconds(0)), 0U);
  EXPECT_EQ(nodes.node_at(Stamp::from_seconds(7.5)), 3U);
  EXPECT_EQ(nodes.node_at(Stamp::from_seconds(10)), 5U);
  EXPECT_DEATH(nodes.node_at(Stamp::from_seconds(7)), "has a node");
}

}  // namespace
}  // namespace radioslam
