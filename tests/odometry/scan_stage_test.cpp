#include "radioslam/odometry/scan_stage.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "lidar/scan_drive.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/mission/odometry_edge.hpp"
#include "radioslam/pipeline/pipeline.hpp"

namespace radioslam {
namespace {

using namespace test;

ScanDrive small_drive(ScannerKind kind = ScannerKind::kPlanar, std::uint64_t seed = 1) {
  Scanner scanner = kind == ScannerKind::kPlanar ? planar_scanner() : Scanner();
  if (kind == ScannerKind::kSpatial) scanner.azimuths = 240;
  return drive_along(furnished_room(), scanner, around_furnished_room(40), seed);
}

/// A robot with scans only, from two seconds into the mission.
Robot scanning_robot(const std::string& id, const ScanDrive& drive) {
  Robot robot;
  robot.id = id;
  robot.lidar = log_of(drive);
  for (Stamp& stamp : robot.lidar.stamps) stamp.ns += 2'000'000'000;
  return robot;
}

Mission mission_of(std::vector<Robot> robots, int dimension = 2) {
  Mission mission;
  mission.name = "scans";
  mission.dimension = dimension;
  mission.robots = std::move(robots);
  return mission;
}

/// Odometry samples from the mission's beginning to two seconds after the last scan, with errors on every
/// step.
Trajectory<SE3> recorded_odometry(const ScanDrive& drive, const SE3& T_start_first) {
  constexpr int kBefore = 20, kAfter = 20;
  const auto scans = static_cast<int>(drive.truth.size());
  const SE3 ahead = SE3::exp(planar_motion(0.1, 0, 0.02)), off = SE3::exp(planar_motion(0.002, 0, 0.001));
  std::vector<StampedPose<SE3>> rows;
  SE3 pose = T_start_first;
  for (int k = 0; k < kBefore + scans + kAfter; ++k) {
    const bool on_the_way = k > kBefore && k < kBefore + scans;
    const auto scan = static_cast<std::size_t>(std::clamp(k - kBefore, 1, scans - 1));
    const SE3 step = on_the_way ? drive.truth[scan - 1].inverse() * drive.truth[scan] : ahead;
    if (k > 0) pose = pose * step * off;
    rows.push_back({Stamp::from_seconds(0.1 * k), pose});
  }
  return Trajectory<SE3>(std::move(rows));
}

/// Gives the mission the odometry of its scans.
MeasuredScans measure(Mission& mission, const ScanParams& params = {}) {
  MeasuredScans measured = measure_scans(mission, params, {}, {});
  mission = with_odometry(std::move(mission), measured, {});
  return measured;
}

SE3 step_between(const Trajectory<SE3>& odometry, Stamp from, Stamp to) {
  return odometry.at(from)->inverse() * *odometry.at(to);
}

void expect_same_bytes(const Trajectory<SE3>& a, const Trajectory<SE3>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].stamp, b[k].stamp);
    EXPECT_EQ(a[k].pose.translation(), b[k].pose.translation());
    EXPECT_EQ(a[k].pose.rotation().coeffs(), b[k].pose.rotation().coeffs());
  }
}

TEST(MeasureScans, GiveARobotItsOdometry) {
  for (const ScannerKind kind : {ScannerKind::kPlanar, ScannerKind::kSpatial}) {
    const ScanDrive drive = small_drive(kind);
    Mission mission = mission_of({scanning_robot("a", drive)}, kind == ScannerKind::kPlanar ? 2 : 3);
    const MeasuredScans measured = measure(mission);
    EXPECT_EQ(measured.scans, 40U);
    EXPECT_EQ(measured.registered, 40U);
    EXPECT_TRUE(measured.notes.empty());
    const auto& odometry = mission.robots[0].odometry;
    ASSERT_EQ(odometry.size(), 40U);
    for (std::size_t k = 0; k < odometry.size(); ++k) {
      EXPECT_EQ(odometry[k].stamp, mission.robots[0].lidar.stamps[k]);
      EXPECT_LT(distance_between(odometry[k].pose, drive.way_to(k)), 0.05);
    }
    const auto& steps = mission.robots[0].odometry_noise.steps;
    ASSERT_EQ(steps.size(), 39U);
    for (std::size_t k = 0; k < steps.size(); ++k) {
      EXPECT_EQ(steps[k].begin, odometry[k].stamp);
      EXPECT_EQ(steps[k].end, odometry[k + 1].stamp);
    }
  }
}

TEST(MeasureScans, LeaveRobotsWithoutScansAsTheyAre) {
  const ScanDrive drive = small_drive();
  Robot without;
  without.id = "b";
  without.odometry = recorded_odometry(drive, SE3());
  Mission mission = mission_of({scanning_robot("a", drive), without});
  measure(mission);
  expect_same_bytes(mission.robots[1].odometry, without.odometry);
  EXPECT_TRUE(mission.robots[1].odometry_noise.steps.empty());
}

TEST(MeasureScans, KeepRecordedOdometryByteForByteOnRequest) {
  const ScanDrive drive = small_drive();
  Robot robot = scanning_robot("a", drive);
  robot.odometry = recorded_odometry(drive, SE3());
  robot.odometry_noise.sigma_xy_per_sqrt_m = 0.0123;
  Mission mission = mission_of({robot, scanning_robot("b", drive)});
  ScanParams params;
  params.stage.odometry = "recorded";
  const MeasuredScans measured = measure(mission, params);
  expect_same_bytes(mission.robots[0].odometry, robot.odometry);
  EXPECT_EQ(mission.robots[0].odometry_noise.sigma_xy_per_sqrt_m, 0.0123);
  EXPECT_TRUE(mission.robots[0].odometry_noise.steps.empty());
  EXPECT_FALSE(mission.robots[1].odometry.empty());  // there is no other
  for (const ScanClosure& closure : measured.closures) EXPECT_EQ(closure.robot, RobotIndex(1));
}

TEST(MeasureScans, AreExtendedByRecordedOdometryBeforeAndAfter) {
  const ScanDrive drive = small_drive();
  Robot robot = scanning_robot("a", drive);
  robot.odometry = recorded_odometry(drive, SE3());
  Mission mission = mission_of({robot});
  measure(mission);
  const auto& odometry = mission.robots[0].odometry;
  const auto& stamps = robot.lidar.stamps;
  ASSERT_EQ(odometry.size(), robot.odometry.size());
  EXPECT_EQ(odometry.front().stamp, robot.odometry.front().stamp);
  EXPECT_EQ(odometry.back().stamp, robot.odometry.back().stamp);
  for (std::size_t k = 1; k < odometry.size(); ++k) {
    const Stamp from = odometry[k - 1].stamp, to = odometry[k].stamp;
    const bool by_scans = from >= stamps.front() && to <= stamps.back();
    const SE3 recorded = step_between(robot.odometry, from, to);
    const auto scan =
        static_cast<std::size_t>(std::clamp<std::int64_t>((from.ns - 2'000'000'000) / 100'000'000, 0, 38));
    const SE3 expected = by_scans ? drive.truth[scan].inverse() * drive.truth[scan + 1] : recorded;
    EXPECT_LT(distance_between(step_between(odometry, from, to), expected), by_scans ? 0.05 : 1e-9) << k;
  }
}

/// Known starts and compasses refer to the frame of the recorded odometry.
TEST(MeasureScans, StayInTheFrameOfTheRecordedOdometry) {
  const ScanDrive drive = small_drive();
  for (const double from_s : {0.0, 2.05, 3.0}) {
    Robot robot = scanning_robot("a", drive);
    const auto whole = recorded_odometry(drive, pose_at(5, -3, 0, 1));
    std::vector<StampedPose<SE3>> rows;
    for (const auto& row : whole)
      if (row.stamp >= Stamp::from_seconds(from_s)) rows.push_back(row);
    robot.odometry = Trajectory<SE3>(rows);
    Mission mission = mission_of({robot});
    measure(mission);
    const auto& odometry = mission.robots[0].odometry;
    const Stamp common = std::max(rows.front().stamp, odometry.front().stamp);
    EXPECT_LT(distance_between(*odometry.at(common), *robot.odometry.at(common)), 0.1) << from_s;
    EXPECT_LT(angle_between(*odometry.at(common), *robot.odometry.at(common)), 3 * kDegree) << from_s;
  }
}

/// A weaving robot, whose scans are deskewed by an outdated motion: each step's noise matches its error, with
/// recorded odometry as well.
TEST(MeasureScans, AccountForMotionDistortion) {
  Scanner scanner = planar_scanner();
  scanner.sweep_s = 0.1;
  std::vector<SE3> poses;
  for (int k = 0; k < 80; ++k) poses.push_back(pose_at(-2 + 0.05 * k, 0, 1.2, 0.3 * std::sin(0.8 * k)));
  for (const bool is_recorded : {false, true}) {
    SE3::Tangent squares = SE3::Tangent::Zero();
    int count = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const ScanDrive drive = drive_along(furnished_room(), scanner, poses, seed);
      Robot robot = scanning_robot("a", drive);
      if (is_recorded) robot.odometry = recorded_odometry(drive, SE3());
      Mission mission = mission_of({robot});
      measure(mission);
      const Trajectory<SE3>& odometry = mission.robots[0].odometry;
      for (std::size_t k = 3; k < drive.truth.size(); ++k) {
        const Stamp from = robot.lidar.stamps[k - 1], to = robot.lidar.stamps[k];
        const SE3 truth = drive.truth[k - 1].inverse() * drive.truth[k];
        const SE3::Tangent error = (step_between(odometry, from, to).inverse() * truth).log();
        const auto noise = measured_covariance(mission.robots[0].odometry_noise.steps, from, to);
        squares.array() += error.array().square() / noise.diagonal().array();
        ++count;
      }
    }
    for (const int axis : {0, 1, 5}) EXPECT_LT(squares[axis] / count, 3) << axis << ' ' << is_recorded;
    EXPECT_GT(squares[5] / count, 0.1) << is_recorded;
  }
}

/// The noise of every step, and that of the steps together over the whole path.
TEST(MeasureScans, StateTheNoiseOfEveryStep) {
  const ScanDrive drive = small_drive();
  Robot robot = scanning_robot("a", drive);
  robot.odometry = recorded_odometry(drive, SE3());
  Mission mission = mission_of({robot});
  measure(mission);
  const auto& [odometry, noise] = std::pair(mission.robots[0].odometry, mission.robots[0].odometry_noise);
  ASSERT_EQ(noise.steps.size(), odometry.size() - 1);
  for (std::size_t k = 0; k < noise.steps.size(); ++k) {
    EXPECT_EQ(noise.steps[k].begin, odometry[k].stamp);
    EXPECT_EQ(noise.steps[k].end, odometry[k + 1].stamp);
    EXPECT_GT(noise.steps[k].covariance_per_s.diagonal().minCoeff(), 0);
  }
  // Two seconds of recorded odometry before the scans keep their stated noise.
  const auto before = odometry_edge<SE2>(odometry, 0, 20, noise).covariance;
  const auto stated = odometry_edge<SE2>(robot.odometry, 0, 20, robot.odometry_noise).covariance;
  EXPECT_LT((before - stated).norm(), 0.05 * stated.norm());
  const auto by_scans = odometry_edge<SE2>(odometry, 20, 59, noise).covariance;
  EXPECT_LT(by_scans(0, 0) + by_scans(1, 1), 0.3 * 0.3);
}

/// Between scans far apart the recorded path is kept, not a straight line.
TEST(MeasureScans, AreBridgedByRecordedOdometryAcrossAGap) {
  const ScanDrive drive = small_drive();
  Robot robot = scanning_robot("a", drive);
  robot.odometry = recorded_odometry(drive, SE3());
  const LidarLog whole = robot.lidar;
  constexpr std::size_t kBegin = 15, kEnd = 25;
  robot.lidar.stamps.erase(robot.lidar.stamps.begin() + kBegin, robot.lidar.stamps.begin() + kEnd);
  robot.lidar.read = [whole](std::size_t k) { return whole.read(k < kBegin ? k : k + kEnd - kBegin); };
  Mission mission = mission_of({robot});
  EXPECT_TRUE(measure(mission).notes.empty());
  const auto& odometry = mission.robots[0].odometry;
  EXPECT_EQ(odometry.size(), robot.odometry.size());
  EXPECT_EQ(mission.robots[0].odometry_noise.steps.size(), odometry.size() - 1);
  const SE3 T_odometry_first = *odometry.at(whole.stamps.front());
  for (std::size_t k = 0; k < whole.size(); ++k)
    EXPECT_LT(distance_between(*odometry.at(whole.stamps[k]), T_odometry_first * drive.way_to(k)), 0.08) << k;
}

/// The recording pauses while the wheels are counted on: a robot that can have moved like this has. One that
/// cannot was carried, or its odometry began again.
TEST(MeasureScans, CrossAPauseOfTheWholeRecordingAsFastAsTheRobotHasBeen) {
  const ScanDrive drive = small_drive();
  constexpr std::size_t kBegin = 12, kEnd = 28;
  for (const double jump_m : {0.0, 30.0}) {
    Robot robot = scanning_robot("a", drive);
    const LidarLog whole = robot.lidar;
    std::vector<StampedPose<SE3>> rows;
    for (const auto& row : recorded_odometry(drive, SE3())) {
      if (whole.stamps[kBegin] <= row.stamp && row.stamp < whole.stamps[kEnd]) continue;
      const double x = row.stamp < whole.stamps[kEnd] ? 0 : jump_m;
      rows.push_back({row.stamp, SE3({x, 0, 0}, Eigen::Quaterniond::Identity()) * row.pose});
    }
    robot.odometry = Trajectory<SE3>(std::move(rows));
    robot.lidar.stamps.erase(robot.lidar.stamps.begin() + kBegin, robot.lidar.stamps.begin() + kEnd);
    robot.lidar.read = [whole](std::size_t k) { return whole.read(k < kBegin ? k : k + kEnd - kBegin); };
    Mission mission = mission_of({robot});
    const MeasuredScans measured = measure(mission);
    const auto& odometry = mission.robots[0].odometry;
    const SE3 way = odometry.at(whole.stamps.front())->inverse() * *odometry.at(whole.stamps.back());
    const double error_m = distance_between(way, drive.way());
    if (jump_m > 0) {
      EXPECT_TRUE(error_m < 0.1 || !measured.notes.empty()) << error_m;
      continue;
    }
    EXPECT_TRUE(measured.notes.empty()) << measured.notes.front();
    EXPECT_LT(error_m, 0.1);
  }
}

TEST(MeasureScans, NoteOdometryThatIsNotConnected) {
  const ScanDrive drive = small_drive();
  Robot robot = scanning_robot("a", drive);
  const auto whole = recorded_odometry(drive, SE3());
  std::vector<StampedPose<SE3>> rows(whole.begin(), whole.begin() + 10);
  robot.odometry = Trajectory<SE3>(rows);
  Mission mission = mission_of({robot});
  const MeasuredScans measured = measure(mission);
  ASSERT_EQ(measured.notes.size(), 1U);
  EXPECT_NE(measured.notes[0].find("10 rows of recorded odometry"), std::string::npos) << measured.notes[0];
}

LidarLog broken_log(std::size_t count) {
  LidarLog log;
  for (std::size_t k = 0; k < count; ++k) log.stamps.push_back(Stamp::from_seconds(static_cast<double>(k)));
  log.read = [](std::size_t k) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    return k % 2 == 0 ? LidarScan{} : LidarScan{std::vector<Eigen::Vector3f>(100, {nan, nan, nan}), {}};
  };
  return log;
}

TEST(MeasureScans, NoteWhatWasIgnored) {
  Robot robot = scanning_robot("a", small_drive());
  const LidarLog good = robot.lidar;
  robot.lidar.read = [good](std::size_t k) {
    LidarScan scan = k % 10 == 5 ? LidarScan{} : good.read(k);
    if (k == 3) scan.points.emplace_back(481.0F, 0.0F, 0.0F);
    return scan;
  };
  Mission mission = mission_of({robot});
  const MeasuredScans measured = measure(mission);
  EXPECT_EQ(measured.scans, 40U);
  EXPECT_EQ(measured.registered, 36U);
  ASSERT_EQ(measured.notes.size(), 2U);
  EXPECT_NE(measured.notes[0].find("robot a: 4 scans"), std::string::npos) << measured.notes[0];
  EXPECT_NE(measured.notes[1].find("robot a: 1 points"), std::string::npos) << measured.notes[1];
}

TEST(MeasureScans, OfNoUseLeaveRecordedOdometry) {
  Robot robot;
  robot.id = "a";
  robot.lidar = broken_log(20);
  robot.odometry = recorded_odometry(small_drive(), SE3());
  Mission mission = mission_of({robot});
  EXPECT_EQ(measure(mission).registered, 0U);
  expect_same_bytes(mission.robots[0].odometry, robot.odometry);
}

TEST(Pipeline, RunsOnScansAlone) {
  for (const ScannerKind kind : {ScannerKind::kPlanar, ScannerKind::kSpatial}) {
    const ScanDrive drive = small_drive(kind);
    const Mission mission = mission_of({scanning_robot("a", drive)}, kind == ScannerKind::kPlanar ? 2 : 3);
    const RunResult result = run_pipeline(mission, {}).result;
    ASSERT_EQ(result.robots.size(), 1U);
    EXPECT_EQ(result.timings.front().stage, "scans");
    EXPECT_EQ(result.counts.at("scans"), 40);
    EXPECT_EQ(result.counts.at("scans_registered"), 40);
    const auto& estimate = result.robots[0].estimate;
    EXPECT_EQ(estimate.front().stamp, mission.robots[0].lidar.stamps.front());
    EXPECT_EQ(estimate.back().stamp, mission.robots[0].lidar.stamps.back());
    for (const auto& [stamp, pose] : estimate) {
      const auto k = static_cast<std::size_t>((stamp.ns - 2'000'000'000) / 100'000'000);
      const SE3 expected = estimate.front().pose * drive.way_to(k);
      EXPECT_LT(distance_between(pose, expected), 0.05) << k;
      EXPECT_LT(angle_between(pose, expected), kDegree) << k;
    }
  }
}

/// Only its start is known.
TEST(Pipeline, RunsWithARobotWhoseScansAreOfNoUse) {
  Robot blind;
  blind.id = "b";
  blind.lidar = broken_log(20);
  const Mission mission = mission_of({scanning_robot("a", small_drive()), blind});
  const RunResult result = run_pipeline(mission, {}).result;
  ASSERT_EQ(result.robots.size(), 2U);
  EXPECT_EQ(result.robots[1].estimate.size(), 1U);
  EXPECT_TRUE(std::any_of(result.notes.begin(), result.notes.end(), [](const std::string& note) {
    return note.find("robot b: 20 scans") != std::string::npos;
  }));
}

TEST(Pipeline, ReportsTheLoopsThatScansClose) {
  auto poses = around_furnished_room(40);
  const auto again = poses;
  poses.insert(poses.end(), again.begin(), again.end());
  const ScanDrive drive = drive_along(furnished_room(), planar_scanner(), poses, 3);
  const Mission mission = mission_of({scanning_robot("a", drive)});
  RunParams params;
  params.scans.loops.known_sigma_m = 0;  // try them however certain the odometry is
  params.scans.loops.min_path_m = 5;
  const RunResult result = run_pipeline(mission, params).result;
  std::size_t accepted = 0;
  for (const ClosureResult& closure : result.closures) {
    EXPECT_EQ(closure.kind, ClosureKind::kLidar);
    EXPECT_LT(closure.stamp_i, closure.stamp_j);
    EXPECT_EQ(closure.status == ClosureStatus::kAccepted, closure.reason.empty());
    if (closure.status == ClosureStatus::kAccepted) ++accepted;
  }
  EXPECT_GT(accepted, 2U);
  const auto& estimate = result.robots[0].estimate;
  EXPECT_LT(distance_between(estimate.back().pose, estimate.front().pose * drive.way()), 0.05);
}

TEST(Pipeline, WithScansGivesTheSameNumbersForAnyNumberOfThreads) {
  const ScanDrive drive = small_drive(ScannerKind::kSpatial);
  Robot robot = scanning_robot("a", drive);
  robot.odometry = recorded_odometry(drive, SE3());
  const Mission mission = mission_of({robot}, 3);
  set_thread_count(1);
  const RunResult alone = run_pipeline(mission, {}).result;
  set_thread_count(3);
  const RunResult together = run_pipeline(mission, {}).result;
  set_thread_count(0);
  expect_same_bytes(alone.robots[0].estimate, together.robots[0].estimate);
  expect_same_bytes(alone.robots[0].odometry, together.robots[0].odometry);
  EXPECT_EQ(alone.closures.size(), together.closures.size());
}

/// Along plain walls whose ends are out of sight.
Robot robot_in_corridor(ScannerKind kind) {
  ScannedRoom corridor;
  corridor.boxes = {{{-300, -1.2, 0}, {300, 1.2, 2.6}}};
  Scanner scanner = kind == ScannerKind::kPlanar ? planar_scanner() : Scanner();
  if (kind == ScannerKind::kSpatial) scanner.azimuths = 240;
  std::vector<SE3> poses;
  const int scans = kind == ScannerKind::kPlanar ? 230 : 70;
  for (int k = 0; k < scans; ++k) poses.push_back(pose_at(0.3 * k, 0.1, 1.2, 0));
  return scanning_robot("a", drive_along(corridor, scanner, poses, 1));
}

TEST(ScanStage, ThatScansLookAlikeAlongACorridorIsNotedUnlessOdometryMeasuresTheMotion) {
  const auto says_so = [](const Robot& robot) {
    Mission mission = mission_of({robot});
    const auto notes = measure(mission).notes;
    return std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
      return note.find("robot a: for ") == 0 &&
             note.find("look alike along one direction") != std::string::npos;
    });
  };
  for (const ScannerKind kind : {ScannerKind::kSpatial, ScannerKind::kPlanar}) {
    Robot robot = robot_in_corridor(kind);
    EXPECT_TRUE(says_so(robot));
    std::vector<StampedPose<SE3>> rows;
    for (int k = 0; k < 280; ++k)
      rows.push_back({Stamp::from_seconds(0.1 * k), SE3({0.3 * k, 0, 0}, Eigen::Quaterniond::Identity())});
    robot.odometry = Trajectory<SE3>(std::move(rows));
    EXPECT_FALSE(says_so(robot));
  }
}

}  // namespace
}  // namespace radioslam
