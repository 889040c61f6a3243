#include "radioslam/mission/keyframes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "radioslam/base/random.hpp"

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

TEST(SelectKeyframes, MeasuresFromTheLastKeyframeNotAlongThePath) {
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

TEST(SelectKeyframes, KeepsTheFirstAndTheLastSampleOnce) {
  EXPECT_EQ(select_keyframes(one_row_per_second({}), {}), Rows());
  EXPECT_EQ(select_keyframes(one_row_per_second({SE2()}), {}), Rows({0}));
  EXPECT_EQ(select_keyframes(one_row_per_second({SE2(), SE2()}), {}), Rows({0, 1}));
}

/// Incremental selection gives the same keyframes except for the last sample.
TEST(IsNewKeyframe, ChoosesAsSelectKeyframesDoes) {
  Rng rng(4);
  std::vector<SE2> poses{SE2()};
  for (int k = 0; k < 400; ++k) {
    const double way_m = rng.uniform(0, 0.4), turn_rad = rng.normal(0, 0.06);
    poses.push_back(poses.back() * SE2({way_m, 0}, turn_rad));
  }
  const auto odometry = one_row_per_second(poses);
  for (const KeyframeParams& params : {KeyframeParams{}, KeyframeParams{3, 1}, KeyframeParams{0.5, 100}}) {
    Rows chosen{0};
    for (std::size_t i = 1; i < odometry.size(); ++i)
      if (is_new_keyframe(odometry[chosen.back()].pose, odometry[i].pose, params)) chosen.push_back(i);
    if (chosen.back() + 1 < odometry.size()) chosen.push_back(odometry.size() - 1);
    EXPECT_EQ(select_keyframes(odometry, params), chosen);
    EXPECT_GT(chosen.size(), 5U);
  }
}

TEST(IsNewKeyframe, CountsDistanceOrRotation) {
  const SE3 last = lift(SE2({3, -2}, 0.7));
  const auto at = [&](double way_m, double turn_rad) { return last * lift(SE2({0, way_m}, turn_rad)); };
  const KeyframeParams params{2, 0.5};
  EXPECT_FALSE(is_new_keyframe(last, last, params));
  EXPECT_FALSE(is_new_keyframe(last, at(1.99, 0.49), params));
  EXPECT_TRUE(is_new_keyframe(last, at(2.01, 0), params));
  EXPECT_TRUE(is_new_keyframe(last, at(0, -0.51), params));
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

TEST(RefinedKeyframes, LeavesNoSampleFarFromTheInterpolation) {
  Rng rng(3);
  std::vector<SE2> poses{SE2()};
  for (int i = 0; i < 300; ++i)  // stops, turns and fast motion
    poses.push_back(poses.back() *
                    SE2({rng.uniform() < 0.3 ? 0 : rng.uniform(0, 0.4), 0}, rng.normal(0, 0.05)));
  const auto odometry = one_row_per_second(poses);
  const KeyframeParams params;
  const Rows sparse = select_keyframes(odometry, params), dense = refined_keyframes(odometry, sparse, params);
  EXPECT_GT(dense.size(), sparse.size());
  EXPECT_TRUE(std::includes(dense.begin(), dense.end(), sparse.begin(), sparse.end()));
  std::vector<StampedPose<SE3>> kept;
  for (const std::size_t row : dense) kept.push_back(odometry[row]);
  const Trajectory<SE3> drawn(std::move(kept));
  for (const auto& row : odometry) {
    const SE3 off = drawn.at(row.stamp)->inverse() * row.pose;
    EXPECT_LE(off.translation().norm(), params.max_deviation_m + 1e-12);
    EXPECT_LE(off.log().tail<3>().norm(), params.max_deviation_rad + 1e-12);
  }
}

TEST(RefinedKeyframes, AddsNothingToAnEvenDriveOrWithoutAllowances) {
  std::vector<SE2> even{SE2()}, uneven{SE2()};
  for (int i = 0; i < 50; ++i) even.push_back(even.back() * SE2({0.1, 0}, 0.01));
  for (int i = 0; i < 50; ++i) uneven.push_back(uneven.back() * SE2({i % 7 == 0 ? 0.6 : 0, 0}, 0.01));
  const KeyframeParams params, any{1, 0.17, 0, 0};
  const Rows keyframes = select_keyframes(one_row_per_second(even), params);
  EXPECT_EQ(refined_keyframes(one_row_per_second(even), keyframes, params), keyframes);
  const Rows others = select_keyframes(one_row_per_second(uneven), any);
  EXPECT_EQ(refined_keyframes(one_row_per_second(uneven), others, any), others);
  EXPECT_EQ(refined_keyframes({}, {}, params), Rows());
}

}  // namespace
}  // namespace radioslam
