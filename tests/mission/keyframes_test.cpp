#include "radioslam/mission/keyframes.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace radioslam {
namespace {

using Rows = std::vector<std::size_t>;

constexpr double kDegree = std::numbers::pi / 180;

Trajectory<SE3> one_row_per_second(const std::vector<SE2>& poses) {
  std::vector<StampedPose<SE3>> rows;
  for (std::size_t i = 0; i < poses.size(); ++i)
    rows.push_back({Stamp::from_seconds(static_cast<double>(i)), lift(poses[i])});
  return Trajectory<SE3>(std::move(rows));
}

TEST(SelectKeyframes, TakesOneEveryMetre) {
  std::vector<SE2> poses;
  for (int i = 0; i <= 14; ++i) poses.emplace_back(Eigen::Vector2d(0.25 * i, 0), 0);
  EXPECT_EQ(select_keyframes(one_row_per_second(poses), {}), Rows({0, 4, 8, 12, 14}));
}

TEST(SelectKeyframes, TakesOneEveryTenDegrees) {
  std::vector<SE2> poses;
  for (int i = 0; i <= 9; ++i) poses.emplace_back(Eigen::Vector2d::Zero(), (170 + 3 * i) * kDegree);
  EXPECT_EQ(select_keyframes(one_row_per_second(poses), {}), Rows({0, 4, 8, 9}));
}

TEST(SelectKeyframes, MeasuresFromTheLastKeyframeNotAlongTheWay) {
  std::vector<SE2> poses;
  for (int i = 0; i < 20; ++i) poses.emplace_back(Eigen::Vector2d(0.75 * (i % 2), 0), 0);
  EXPECT_EQ(select_keyframes(one_row_per_second(poses), {}), Rows({0, 19}));
}

TEST(SelectKeyframes, ObeysItsParameters) {
  std::vector<SE2> poses;
  for (int i = 0; i <= 8; ++i) poses.emplace_back(Eigen::Vector2d(0.5 * i, 0), 3 * i * kDegree);
  EXPECT_EQ(select_keyframes(one_row_per_second(poses), {2, 1}), Rows({0, 4, 8}));
  EXPECT_EQ(select_keyframes(one_row_per_second(poses), {100, 5 * kDegree}), Rows({0, 2, 4, 6, 8}));
}

TEST(SelectKeyframes, KeepsTheFirstAndTheLastRowOnce) {
  EXPECT_EQ(select_keyframes(one_row_per_second({}), {}), Rows());
  EXPECT_EQ(select_keyframes(one_row_per_second({SE2()}), {}), Rows({0}));
  EXPECT_EQ(select_keyframes(one_row_per_second({SE2(), SE2()}), {}), Rows({0, 1}));
}

TEST(KeyframeBefore, IsTheLastOneNotLaterThanTheStamp) {
  const std::vector<Stamp> keyframes{{10}, {20}, {30}};
  EXPECT_EQ(keyframe_before(keyframes, {9}), 0U);
  EXPECT_EQ(keyframe_before(keyframes, {10}), 0U);
  EXPECT_EQ(keyframe_before(keyframes, {19}), 0U);
  EXPECT_EQ(keyframe_before(keyframes, {20}), 1U);
  EXPECT_EQ(keyframe_before(keyframes, {29}), 1U);
  EXPECT_EQ(keyframe_before(keyframes, {99}), 2U);
}

}  // namespace
}  // namespace radioslam
