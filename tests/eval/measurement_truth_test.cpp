#include "radioslam/eval/measurement_truth.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace radioslam {
namespace {

/// Robot a stands at the origin, b at (3, 4), turned by a quarter; one keyframe each.
class MeasurementTruth : public testing::Test {
 protected:
  MeasurementTruth() {
    mission.dimension = 2;
    mission.robots.resize(2);
    const auto standing = [](const SE2& pose) {
      return Trajectory<SE3>(std::vector<StampedPose<SE3>>{{Stamp::from_seconds(0), lift(pose)},
                                                           {Stamp::from_seconds(9), lift(pose)}});
    };
    truth.robots = {{"a", standing(SE2())}, {"b", standing(T_a_b)}};
  }
  void add(ClosureKind kind, ClosureStatus status) {
    closures.push_back({a, Stamp{}, b, Stamp{}, kind, status, 0, ""});
  }
  std::map<ClosureKind, JudgedClosures> judge() const {
    return judge_closures(closures, {{Stamp{}}, {Stamp{}}}, mission, truth);
  }

  const RobotIndex a{0}, b{1};
  const SE2 T_a_b{{3, 4}, 1.5707963};
  const Stamp at = Stamp::from_seconds(1);
  Mission mission;
  Truth truth;
  std::vector<ClosureResult> closures;
};

TEST_F(MeasurementTruth, AMatchIsTrueByItsRelativePoseNotByItsPlaces) {
  mission.matches.push_back({a, b, at, at, lift(T_a_b * SE2({0.4, 0}, 0)), 0.1, 0.01});
  mission.matches.push_back({a, b, at, at, lift(T_a_b * SE2({5, 0}, 0)), 0.1, 0.01});    // an alias
  mission.matches.push_back({a, b, at, at, lift(T_a_b * SE2({0, 0}, 0.2)), 0.1, 0.01});  // 11 degrees
  for (int k = 0; k < 3; ++k) add(ClosureKind::kMatch, ClosureStatus::kAccepted);
  EXPECT_EQ(judge().at(ClosureKind::kMatch).accepted, 3U);
  EXPECT_EQ(judge().at(ClosureKind::kMatch).true_accepted, 1U);
}

TEST_F(MeasurementTruth, LabelsTakePrecedence) {
  mission.matches.push_back({a, b, at, at, lift(T_a_b), 0.1, 0.01});
  truth.true_matches = {false};
  add(ClosureKind::kMatch, ClosureStatus::kRejected);
  EXPECT_EQ(judge().at(ClosureKind::kMatch).rejected, 1U);
  EXPECT_EQ(judge().at(ClosureKind::kMatch).true_rejected, 0U);
}

TEST_F(MeasurementTruth, RangesAndAnglesAreComparedWithTheTrueAntennas) {
  const LinkEnd of_a{a, {}, "", Eigen::Vector3d::Zero()}, of_b{b, {}, "", Eigen::Vector3d(1, 0, 0)};
  const double distance = std::hypot(3, 5);  // b's antenna is at (3, 5)
  mission.ranges.push_back({at, of_a, of_b, distance + 0.7, 0.1});
  mission.ranges.push_back({at, of_a, of_b, distance + 0.9, 0.1});
  add(ClosureKind::kRange, ClosureStatus::kAccepted);
  add(ClosureKind::kRange, ClosureStatus::kRejected);
  const AoaPath direct{std::atan2(5, 3), {}, 0.02, 0}, reflected{-2, {}, 0.02, 0};
  mission.aoa_measurements.push_back({at, a, of_b, {reflected, direct}});
  mission.aoa_measurements.push_back({at, a, of_b, {reflected}});
  add(ClosureKind::kAoa, ClosureStatus::kAccepted);
  add(ClosureKind::kAoa, ClosureStatus::kAccepted);
  const auto judged = judge();
  EXPECT_EQ(judged.at(ClosureKind::kRange).true_accepted, 1U);
  EXPECT_EQ(judged.at(ClosureKind::kRange).true_rejected, 0U);
  EXPECT_EQ(judged.at(ClosureKind::kAoa).accepted, 2U);
  EXPECT_EQ(judged.at(ClosureKind::kAoa).true_accepted, 1U);
}

TEST_F(MeasurementTruth, WhatTheTruthDoesNotCoverIsNotCounted) {
  mission.ranges.push_back({Stamp::from_seconds(50), {a, {}, "", {}}, {b, {}, "", {}}, 5, 0.1});
  add(ClosureKind::kRange, ClosureStatus::kAccepted);
  EXPECT_TRUE(judge().empty());
}

}  // namespace
}  // namespace radioslam
