#include "radioslam/eval/measurement_truth.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace radioslam {
namespace {

/// Robot a stands at the origin, b at (3, 4), turned by a quarter; a keyframe each at 0 s and 60 s.
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
  ClosuresByKind compare(const std::vector<MeasuredAoaResult>& measured = {}) const {
    const std::vector<Stamp> stamps{Stamp{}, Stamp::from_seconds(60)};
    return compare_closures_with_truth(closures, {stamps, stamps}, mission, truth, measured, file);
  }

  const RobotIndex a{0}, b{1};
  const SE3::Jacobian small = isotropic_covariance(0.1, 0.01);
  const SE2 T_a_b{{3, 4}, 1.5707963};
  const Stamp at = Stamp::from_seconds(1);
  Mission mission;
  Truth truth;
  FileLoops file;
  std::vector<ClosureResult> closures;
};

TEST_F(MeasurementTruth, AMatchIsTrueByItsRelativePoseNotByItsPlaces) {
  mission.matches.push_back({a, b, at, at, lift(T_a_b * SE2({0.4, 0}, 0)), small});
  mission.matches.push_back({a, b, at, at, lift(T_a_b * SE2({5, 0}, 0)), small});    // an alias
  mission.matches.push_back({a, b, at, at, lift(T_a_b * SE2({0, 0}, 0.2)), small});  // 11 degrees
  for (int k = 0; k < 3; ++k) add(ClosureKind::kMatch, ClosureStatus::kAccepted);
  EXPECT_EQ(compare().at(ClosureKind::kMatch).accepted, 3U);
  EXPECT_EQ(compare().at(ClosureKind::kMatch).true_accepted, 1U);
}

/// 0.7 m off is within 3 sigma + 0.5 m along the loose axis only, 0.2 rad about it is not affected.
TEST_F(MeasurementTruth, AMatchMayErrAlongItsLooseAxis) {
  SE3::Jacobian loose = isotropic_covariance(0.01, 0.01);
  loose(0, 0) = 0.1 * 0.1;
  mission.matches.push_back({a, b, at, at, lift(T_a_b * SE2({0.7, 0}, 0)), loose});
  mission.matches.push_back({a, b, at, at, lift(T_a_b * SE2({0, 0.7}, 0)), loose});
  mission.matches.push_back({a, b, at, at, lift(T_a_b * SE2({0.7, 0}, 0.2)), loose});
  for (int k = 0; k < 3; ++k) add(ClosureKind::kMatch, ClosureStatus::kAccepted);
  EXPECT_EQ(compare().at(ClosureKind::kMatch).true_accepted, 1U);
}

TEST_F(MeasurementTruth, LabelsTakePrecedence) {
  mission.matches.push_back({a, b, at, at, lift(T_a_b), small});
  truth.true_matches = {false};
  add(ClosureKind::kMatch, ClosureStatus::kRejected);
  EXPECT_EQ(compare().at(ClosureKind::kMatch).rejected, 1U);
  EXPECT_EQ(compare().at(ClosureKind::kMatch).true_rejected, 0U);
}

/// The k-th closure of a pair is the k-th loop of the pair, whatever comes between.
TEST_F(MeasurementTruth, LoopsOfAFileAreComparedInItsOrder) {
  const Stamp start{};
  const auto add_loop = [&](double off_m) {
    file.loops.push_back({a, b, start, start, lift(T_a_b * SE2({off_m, 0}, 0)), small});
  };
  add_loop(0.6);
  file.loops.push_back({b, a, start, start, lift(T_a_b.inverse()), small});
  add_loop(9);
  add_loop(0.1);
  add(ClosureKind::kFile, ClosureStatus::kAccepted);
  closures.push_back({b, start, a, start, ClosureKind::kFile, ClosureStatus::kRejected, 0, ""});
  add(ClosureKind::kFile, ClosureStatus::kRejected);
  add(ClosureKind::kFile, ClosureStatus::kAccepted);
  const ComparedClosures counts = compare().at(ClosureKind::kFile);
  EXPECT_EQ(counts.accepted, 2U);
  EXPECT_EQ(counts.true_accepted, 2U);
  EXPECT_EQ(counts.rejected, 2U);
  EXPECT_EQ(counts.true_rejected, 1U);
  EXPECT_NEAR(counts.worst_accepted_m.value(), 0.6, 1e-9);
  EXPECT_NEAR(counts.worst_accepted_rad.value(), 0, 1e-6);
}

/// Poses of a graph that are not placed are no keyframes of the run, and their loops keep their own stamps.
TEST_F(MeasurementTruth, LoopsOfPosesThatAreNotPlacedAreThemselves) {
  const Stamp later = Stamp::from_seconds(70), start{};
  file.loops = {{a, b, later, start, SE3(), small}, {a, b, start, start, lift(T_a_b), small}};
  closures.push_back({a, later, b, start, ClosureKind::kFile, ClosureStatus::kRejected, 0, ""});
  add(ClosureKind::kFile, ClosureStatus::kAccepted);
  EXPECT_EQ(compare().at(ClosureKind::kFile).true_accepted, 1U);
}

TEST_F(MeasurementTruth, LabelsOfAFileCountWithoutTruth) {
  truth.robots[1].poses = {};
  file.loops = {{a, b, Stamp{}, Stamp{}, SE3(), small}, {a, b, Stamp{}, Stamp{}, SE3(), small}};
  for (int k = 0; k < 2; ++k) add(ClosureKind::kFile, ClosureStatus::kAccepted);
  EXPECT_TRUE(compare().empty());
  file.labels = {true, false};
  EXPECT_EQ(compare().at(ClosureKind::kFile).accepted, 2U);
  EXPECT_EQ(compare().at(ClosureKind::kFile).true_accepted, 1U);
  EXPECT_FALSE(compare().at(ClosureKind::kFile).worst_accepted_m);
}

TEST_F(MeasurementTruth, RangesAreComparedWithTheTrueAntennas) {
  const LinkEnd of_a{a, {}, "", Eigen::Vector3d::Zero()}, of_b{b, {}, "", Eigen::Vector3d(1, 0, 0)};
  const double distance = std::hypot(3, 5);  // b's antenna is at (3, 5)
  mission.ranges.push_back({at, of_a, of_b, distance + 0.7, 0.1});
  mission.ranges.push_back({at, of_a, of_b, distance + 0.9, 0.1});
  add(ClosureKind::kRange, ClosureStatus::kAccepted);
  add(ClosureKind::kRange, ClosureStatus::kRejected);
  const auto compared = compare();
  EXPECT_EQ(compared.at(ClosureKind::kRange).true_accepted, 1U);
  EXPECT_EQ(compared.at(ClosureKind::kRange).true_rejected, 0U);
}

/// Angles at a from b's antenna at (3, 5), with one path that points there and two that do not.
class AngleTruthOfRun : public MeasurementTruth {
 protected:
  void add_angle(std::vector<AoaPath> paths, std::vector<double> weights,
                 ClosureStatus status = ClosureStatus::kAccepted) {
    mission.aoa_measurements.push_back({at, a, of_b, std::move(paths)});
    add(ClosureKind::kAoa, status);
    closures.back().path_weights = std::move(weights);
  }
  ComparedClosures angles() const { return compare().at(ClosureKind::kAoa); }

  const LinkEnd of_b{b, {}, "", Eigen::Vector3d(1, 0, 0)};
  const AoaPath direct{std::atan2(5, 3), {}, 0.02, 0}, reflected{-2, {}, 0.02, 0}, other{2.5, {}, 0.02, 0};
};

TEST_F(AngleTruthOfRun, TheLikeliestPathDecidesNotAnyPath) {
  add_angle({reflected, direct}, {0.1, 0.8});            // found
  add_angle({reflected, direct}, {0.5, 0.4});            // wrong path
  add_angle({reflected, direct, other}, {0, 0.4, 0.5});  // wrong path
  add_angle({reflected, other}, {0.9, 0});               // none direct
  add_angle({direct}, {});                               // found: no other path
  const ComparedClosures counts = angles();
  EXPECT_EQ(counts.accepted, 5U);
  EXPECT_EQ(counts.true_accepted, 2U);
  EXPECT_EQ(counts.direct_found, 2U);
  EXPECT_EQ(counts.wrong_path, 2U);
  EXPECT_EQ(counts.none_direct, 1U);
}

TEST_F(AngleTruthOfRun, ARejectedAngleIsTrueIfItsLikeliestPathIsDirect) {
  add_angle({reflected, direct}, {0.1, 0.2}, ClosureStatus::kRejected);
  add_angle({reflected, direct}, {0.2, 0.1}, ClosureStatus::kRejected);
  add_angle({reflected, other}, {0.2, 0.1}, ClosureStatus::kRejected);
  const ComparedClosures counts = angles();
  EXPECT_EQ(counts.rejected, 3U);
  EXPECT_EQ(counts.true_rejected, 1U);
  EXPECT_EQ(counts.direct_found + counts.wrong_path + counts.none_direct, 0U);
}

TEST_F(AngleTruthOfRun, LabelsTakePrecedenceOverGeometry) {
  for (int k = 0; k < 4; ++k) add_angle({reflected, direct}, {0.9, 0.1});
  truth.direct_paths = {0, 1, kNoDirectPath, std::nullopt};  // the last one by geometry: wrong path
  const ComparedClosures counts = angles();
  EXPECT_EQ(counts.direct_found, 1U);
  EXPECT_EQ(counts.wrong_path, 2U);
  EXPECT_EQ(counts.none_direct, 1U);
}

TEST_F(AngleTruthOfRun, ThreeSigmaAndFiveDegreesAreWithinTheDirection) {
  const double tolerance_rad = 3 * 0.02 + 5 * 3.14159265 / 180;
  AoaPath near = direct, beyond = direct;
  near.azimuth_rad += tolerance_rad - 0.001;
  beyond.azimuth_rad += tolerance_rad + 0.001;
  add_angle({near}, {1});
  add_angle({beyond}, {1});
  EXPECT_EQ(angles().direct_found, 1U);
  EXPECT_EQ(angles().none_direct, 1U);
}

TEST_F(AngleTruthOfRun, SeveralPathsWithoutTheirWeightsAreNotCompared) {
  add_angle({reflected, direct}, {});
  add_angle({reflected, direct}, {1});
  EXPECT_TRUE(compare().empty());
}

TEST_F(AngleTruthOfRun, AnglesFromCsiAreComparedInTheOrderOfTheRun) {
  add_angle({reflected, direct}, {0.1, 0.8});  // of the mission, at 1 s
  mission.robots[0].id = "a";
  mission.robots[1].id = "b";
  mission.robots[1].csi.emplace().antennas_m = {Eigen::Vector3d(1, 0, 0)};
  const auto from_csi = [&](double t_s, std::vector<AoaPath> paths) {
    MeasuredAoaResult result;
    result.receiver = "a";
    result.transmitter = "b";
    result.stamp = Stamp::from_seconds(t_s);
    result.paths = std::move(paths);
    return result;
  };
  // By time: wrong path at 0.5 s, the mission's, none direct at 2 s; the truth ends at 9 s.
  const std::vector<MeasuredAoaResult> measured = {from_csi(2, {reflected, other}),
                                                   from_csi(0.5, {other, direct, reflected})};
  closures.front().path_weights = {0.6, 0.3, 0};
  for (const std::vector<double>& weights : {std::vector{0.1, 0.8}, std::vector{0.7, 0.1}}) {
    add(ClosureKind::kAoa, ClosureStatus::kAccepted);
    closures.back().path_weights = weights;
  }
  const auto counts = compare(measured).at(ClosureKind::kAoa);
  EXPECT_EQ(counts.accepted, 3U);
  EXPECT_EQ(counts.direct_found, 1U);
  EXPECT_EQ(counts.wrong_path, 1U);
  EXPECT_EQ(counts.none_direct, 1U);
}

TEST_F(AngleTruthOfRun, ATransmitterWithoutOrientationIsAPositionIfItsAntennaIsAtTheOrigin) {
  add_angle({{std::atan2(4, 3), {}, 0.02, 0}}, {1});
  truth.robots[1].has_orientation = false;
  EXPECT_TRUE(compare().empty());
  mission.aoa_measurements[0].transmitter.lever_arm_m.setZero();
  EXPECT_EQ(angles().direct_found, 1U);
}

/// The run has no closure of a link at a time without odometry, so that the next one is not its closure.
TEST_F(AngleTruthOfRun, LinksBeyondTheOdometryHaveNoClosure) {
  mission.aoa_measurements.push_back({Stamp::from_seconds(-1), a, of_b, {reflected}});
  add_angle({direct}, {1});
  EXPECT_EQ(angles().direct_found, 1U);
}

TEST_F(MeasurementTruth, WhatTheTruthDoesNotCoverIsNotCounted) {
  mission.ranges.push_back({Stamp::from_seconds(50), {a, {}, "", {}}, {b, {}, "", {}}, 5, 0.1});
  add(ClosureKind::kRange, ClosureStatus::kAccepted);
  EXPECT_TRUE(compare().empty());
}

}  // namespace
}  // namespace radioslam
