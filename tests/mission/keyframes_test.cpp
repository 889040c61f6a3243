#include "radioslam/mission/keyframes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr RobotIndex kRobot{0};

/// One row per second.
Mission drive(const std::vector<SE2>& poses) {
  std::vector<StampedPose<SE3>> rows;
  for (std::size_t i = 0; i < poses.size(); ++i)
    rows.push_back({Stamp::from_seconds(static_cast<double>(i)), lift(poses[i])});
  Mission mission;
  mission.robots.resize(1);
  mission.robots[0].odometry = Trajectory<SE3>(std::move(rows));
  return mission;
}

/// Ten seconds along x, at this speed.
Mission straight_drive(double speed_mps) {
  std::vector<SE2> poses;
  for (int i = 0; i <= 10; ++i) poses.emplace_back(Eigen::Vector2d(speed_mps * i, 0), 0);
  return drive(poses);
}

using Seconds = std::vector<double>;

Seconds seconds_of(const std::vector<Stamp>& stamps) {
  Seconds result;
  for (const Stamp stamp : stamps) result.push_back(stamp.seconds());
  return result;
}

Seconds chosen(const Mission& mission, const KeyframeParams& params = {},
               const std::vector<Stamp>& given = {}) {
  return seconds_of(choose_keyframes(mission, kRobot, params, given));
}

Stamp at(double seconds) { return Stamp::from_seconds(seconds); }

TEST(ChooseKeyframes, TakesOneEveryMetre) { EXPECT_EQ(chosen(straight_drive(0.25)), Seconds({0, 4, 8, 10})); }

TEST(ChooseKeyframes, TakesOneEveryTenDegrees) {
  std::vector<SE2> poses;
  for (int i = 0; i <= 9; ++i) poses.emplace_back(Eigen::Vector2d::Zero(), (170 + 3 * i) * kDegree);
  EXPECT_EQ(chosen(drive(poses)), Seconds({0, 4, 8, 9}));
}

TEST(ChooseKeyframes, MeasuresFromTheLastKeyframeNotAlongThePath) {
  std::vector<SE2> poses;
  for (int i = 0; i < 20; ++i) poses.emplace_back(Eigen::Vector2d(0.75 * (i % 2), 0), 0);
  EXPECT_EQ(chosen(drive(poses), {1, 0.17, 0, 0}), Seconds({0, 19}));
}

TEST(ChooseKeyframes, ObeysItsParameters) {
  std::vector<SE2> poses;
  for (int i = 0; i <= 8; ++i) poses.emplace_back(Eigen::Vector2d(0.5 * i, 0), 3 * i * kDegree);
  EXPECT_EQ(chosen(drive(poses), {2, 1, 0, 0}), Seconds({0, 4, 8}));
  EXPECT_EQ(chosen(drive(poses), {100, 5 * kDegree, 0, 0}), Seconds({0, 2, 4, 6, 8}));
}

TEST(ChooseKeyframes, KeepsTheFirstAndTheLastSampleOnce) {
  EXPECT_EQ(chosen(drive({})), Seconds());
  EXPECT_EQ(chosen(drive({SE2()})), Seconds({0}));
  EXPECT_EQ(chosen(drive({SE2(), SE2()})), Seconds({0, 1}));
}

/// Stops, turns and fast motion.
std::vector<SE2> uneven_poses(int count) {
  Rng rng(3);
  std::vector<SE2> poses{SE2()};
  for (int i = 0; i < count; ++i)
    poses.push_back(poses.back() *
                    SE2({rng.uniform() < 0.3 ? 0 : rng.uniform(0, 0.4), 0}, rng.normal(0, 0.05)));
  return poses;
}

TEST(ChooseKeyframes, LeavesNoSampleFarFromTheInterpolation) {
  const Mission mission = drive(uneven_poses(300));
  const Trajectory<SE3>& odometry = mission.robots[0].odometry;
  const KeyframeParams params;
  const auto keyframes = choose_keyframes(mission, kRobot, params);
  EXPECT_GT(keyframes.size(), chosen(mission, {1, params.angle_rad, 0, 0}).size());
  std::vector<StampedPose<SE3>> kept;
  for (const Stamp stamp : keyframes) kept.push_back({stamp, *odometry.at(stamp)});
  const Trajectory<SE3> drawn(std::move(kept));
  for (const auto& row : odometry) {
    const SE3 off = drawn.at(row.stamp)->inverse() * row.pose;
    EXPECT_LE(off.translation().norm(), params.max_deviation_m + 1e-12);
    EXPECT_LE(off.log().tail<3>().norm(), params.max_deviation_rad + 1e-12);
  }
}

/// What comes later changes no keyframe but the last: they are numbered for good when they are made.
TEST(ChooseKeyframes, DependsOnThePastAlone) {
  Mission whole = drive(uneven_poses(200));
  for (int k = 0; k < 190; ++k)
    whole.ranges.push_back({at(k + 0.3), {kRobot, {}, {}, {}}, {{}, AnchorIndex(0), {}, {}}, 5, 0.02});
  const auto all = choose_keyframes(whole, kRobot, {});
  const Trajectory<SE3>& odometry = whole.robots[0].odometry;
  for (const std::size_t count : {20UL, 77UL, 150UL}) {
    Mission begun = whole;
    begun.robots[0].odometry =
        Trajectory<SE3>({odometry.begin(), odometry.begin() + static_cast<std::ptrdiff_t>(count)});
    auto early = choose_keyframes(begun, kRobot, {});
    early.pop_back();
    ASSERT_LT(early.size(), all.size());
    EXPECT_TRUE(std::equal(early.begin(), early.end(), all.begin())) << count;
  }
}

/// A metre of odometry is worth 2 cm here.
TEST(ChooseKeyframes, MakesOneOfAMeasurementThatIsBetterThanTheOdometrySince) {
  Mission mission = straight_drive(0.8);
  mission.robots[0].odometry_noise.sigma_xy_per_sqrt_m = 0.02;
  const Seconds plain = chosen(mission, {4, 1});
  EXPECT_EQ(plain, Seconds({0, 5, 10}));
  const auto with = [&](double sigma_m) {
    Mission measured = mission;
    measured.robots[0].fixes.push_back({at(3.5), Eigen::Vector3d::Zero(), sigma_m});
    return chosen(measured, {4, 1});
  };
  EXPECT_EQ(with(1), plain);
  EXPECT_EQ(with(0.05), plain) << "2.8 m, 3.3 cm";
  EXPECT_EQ(with(0.02), Seconds({0, 3.5, 9, 10})) << "and the next one is 4 m further";
  Mission matched = mission;
  matched.matches.push_back({kRobot, kRobot, at(1), at(4), SE3(), isotropic_covariance(0.01, 1)});
  EXPECT_EQ(chosen(matched, {4, 1}), Seconds({0, 1, 4, 9, 10}));
}

TEST(ChooseKeyframes, TakesThoseThatAreGivenWithinTheOdometry) {
  EXPECT_EQ(chosen(straight_drive(0.25), {}, {at(-1), at(0), at(2.5), at(7), at(99)}),
            Seconds({0, 2.5, 7, 10}));
}

/// A robot that stands for hours is looked at once a sample, not once a pair of samples.
TEST(ChooseKeyframes, OfAStandingRobotCostLittle) {
  Mission mission = drive(std::vector<SE2>(100'000, SE2()));
  for (int k = 0; k < 99'000; ++k) mission.robots[0].fixes.push_back({at(k + 0.5), {0, 0, 0}, 0.1});
  EXPECT_EQ(chosen(mission), Seconds({0, 99'999}));
}

/// Neither is one that creeps, along an arc of which no piece is straight.
TEST(ChooseKeyframes, OfACreepingRobotCostLittle) {
  std::vector<SE2> poses{SE2()};
  for (int k = 0; k < 20'000; ++k) poses.push_back(poses.back() * SE2({4e-5, 0}, 5e-6));
  EXPECT_LE(chosen(drive(poses)).size(), 3U);
}

TEST(KeyframesOf, ARobotThatComesWithThemAreThese) {
  Mission mission = straight_drive(0.25);
  EXPECT_EQ(keyframes_of(mission, kRobot, {}), choose_keyframes(mission, kRobot, {}));
  mission.robots[0].keyframes = {at(0), at(6.5), at(10)};
  EXPECT_EQ(keyframes_of(mission, kRobot, {}), mission.robots[0].keyframes);
}

TEST(IsNewKeyframe, CountsDistanceOrRotation) {
  const SE3 last = lift(SE2({3, -2}, 0.7));
  const auto there = [&](double way_m, double turn_rad) { return last * lift(SE2({0, way_m}, turn_rad)); };
  const KeyframeParams params{2, 0.5};
  EXPECT_FALSE(is_new_keyframe(last, last, params));
  EXPECT_FALSE(is_new_keyframe(last, there(1.99, 0.49), params));
  EXPECT_TRUE(is_new_keyframe(last, there(2.01, 0), params));
  EXPECT_TRUE(is_new_keyframe(last, there(0, -0.51), params));
}

TEST(NodesAt, AreSamplesAndWhatIsInterpolatedBetween) {
  const auto nodes = nodes_at(straight_drive(0.4).robots[0].odometry, {at(0), at(3), at(7.5), at(10)});
  EXPECT_EQ(nodes.odometry.size(), 12U) << "only 7.5 s had no sample";
  ASSERT_EQ(nodes.rows.size(), nodes.stamps.size());
  for (std::size_t n = 0; n < nodes.rows.size(); ++n) {
    const auto& [stamp, pose] = nodes.odometry[nodes.rows[n]];
    EXPECT_EQ(stamp, nodes.stamps[n]);
    EXPECT_NEAR(pose.translation().x(), 0.4 * stamp.seconds(), 1e-9);
  }
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
