#include "radioslam/eval/association.hpp"

#include <gtest/gtest.h>

#include "eval/teams.hpp"

namespace radioslam {
namespace {

SE3 at_x(double x) { return SE3({x, 0, 0}, Eigen::Quaterniond::Identity()); }

Trajectory<SE3> along_x(const std::vector<double>& stamps_s) {
  std::vector<StampedPose<SE3>> poses;
  for (const double t : stamps_s) poses.push_back({Stamp::from_seconds(t), at_x(10 * t)});
  return Trajectory<SE3>(poses);
}

std::vector<std::size_t> truth_indices(const std::vector<MatchedPose>& matches) {
  std::vector<std::size_t> indices;
  for (const auto& match : matches) indices.push_back(match.truth_index);
  return indices;
}

TEST(PoseAt, IsLinearInPositionAndTurnsEvenly) {
  const SE3 turned({2, 4, 6}, Eigen::Quaterniond(Eigen::AngleAxisd(1.2, Eigen::Vector3d::UnitZ())));
  const Trajectory<SE3> path({{Stamp::from_seconds(1), SE3()}, {Stamp::from_seconds(3), turned}});
  const auto pose = pose_at(path, Stamp::from_seconds(1.5));
  ASSERT_TRUE(pose);
  EXPECT_LT((pose->translation() - Eigen::Vector3d(0.5, 1, 1.5)).norm(), 1e-12);
  EXPECT_NEAR(pose->yaw(), 0.3, 1e-12);
  EXPECT_FALSE(pose_at(path, Stamp::from_seconds(3.1)));
}

TEST(MatchPoses, InterpolatesAtTheTruthsStampsOnly) {
  const RobotTruth truth{"a", along_x({0.5, 1, 1.25, 2.75, 3.1})};
  const auto matches = match_poses(along_x({1, 2, 3}), truth, Association::kInterpolate);
  EXPECT_EQ(truth_indices(matches), (std::vector<std::size_t>{1, 2, 3}));
  for (const auto& match : matches)
    EXPECT_LT((match.estimate.translation() - match.truth.translation()).norm(), 1e-12);
}

TEST(MatchPoses, HoldsTheEndsForWaypointsPressedALittleEarlyOrLate) {
  const RobotTruth waypoints{"a", along_x({0.4, 0.5, 2, 3.5, 3.6}), false};
  const auto matches = match_poses(along_x({1, 2, 3}), waypoints, Association::kInterpolate);
  ASSERT_EQ(truth_indices(matches), (std::vector<std::size_t>{1, 2, 3}));
  EXPECT_DOUBLE_EQ(matches[0].estimate.translation().x(), 10);
  EXPECT_DOUBLE_EQ(matches[2].estimate.translation().x(), 30);
}

TEST(MatchPoses, NearestGoesThroughTheShorterTrajectory) {
  const RobotTruth dense{"a", along_x({0, 0.005, 0.5, 1.009, 1.02, 2.011})};
  const auto by_estimate = match_poses(along_x({0.001, 1, 2}), dense, Association::kNearest);
  EXPECT_EQ(truth_indices(by_estimate), (std::vector<std::size_t>{0, 3}));  // 2.011 is 11 ms off

  const RobotTruth sparse{"a", along_x({0, 1})};
  const auto by_truth = match_poses(along_x({0.004, 0.008, 0.5, 1.2}), sparse, Association::kNearest);
  ASSERT_EQ(truth_indices(by_truth), (std::vector<std::size_t>{0}));
  EXPECT_DOUBLE_EQ(by_truth[0].estimate.translation().x(), 0.04);
}

TEST(MatchPoses, NothingMatchesNothing) {
  const RobotTruth truth{"a", along_x({1, 2})};
  EXPECT_TRUE(match_poses({}, truth, Association::kInterpolate).empty());
  EXPECT_TRUE(match_poses({}, truth, Association::kNearest).empty());
  EXPECT_TRUE(match_poses(along_x({1, 2}), {"a", {}}, Association::kNearest).empty());
}

TEST(MatchPoses, ASinglePoseIsMatchedAtItsStamp) {
  const RobotTruth truth{"a", along_x({1, 2})};
  EXPECT_EQ(truth_indices(match_poses(along_x({2}), truth, Association::kInterpolate)),
            (std::vector<std::size_t>{1}));
  EXPECT_EQ(truth_indices(match_poses(along_x({2}), truth, Association::kNearest)),
            (std::vector<std::size_t>{1}));
}

}  // namespace
}  // namespace radioslam
