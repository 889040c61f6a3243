#include "radioslam/records/team_log.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include "radioslam/geometry/se2.hpp"
#include "radioslam/mission/odometry_edge.hpp"
#include "radioslam/records/logs_of_mission.hpp"
#include "radioslam/records/mission_of_logs.hpp"
#include "radioslam/records/record_codec.hpp"

namespace radioslam {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

/// Two robots on circles, ten samples a second, with a range a second and what else a log can say.
Mission circling(double seconds = 200) {
  Mission mission;
  mission.anchors = {{"gate", Eigen::Vector3d(5, 5, 2), 0.1}};
  mission.access_points = {"00:00:00:00:00:01", "00:00:00:00:00:02"};
  for (const char* id : {"b", "a"}) {
    Robot& robot = mission.robots.emplace_back();
    robot.id = id;
    std::vector<StampedPose<SE3>> rows;
    for (int k = 0; k <= 10 * static_cast<int>(seconds); ++k) {
      const double angle = 0.01 * k;
      rows.push_back(
          {Stamp{k * kSecond / 10}, lift(SE2({10 * std::sin(angle), 10 - 10 * std::cos(angle)}, angle))});
    }
    robot.odometry = Trajectory<SE3>(std::move(rows));
    robot.wifi = {{Stamp{3 * kSecond}, {{AccessPointIndex(std::size_t{0}), 2412, -50}}}};
    robot.fixes = {{Stamp{4 * kSecond + 1}, {1, 2, 0}, 0.5}};
  }
  for (int k = 0; k < static_cast<int>(seconds); ++k) {
    RangeMeasurement range;
    range.stamp = Stamp{k * kSecond + 12345};
    range.i.robot = RobotIndex(std::size_t{0});
    if (k % 2 == 0)
      range.j.robot = RobotIndex(std::size_t{1});
    else
      range.j.anchor = AnchorIndex(std::size_t{0});
    range.range_m = 3 + k;
    range.sigma_m = 0.1;
    mission.ranges.push_back(range);
  }
  AoaMeasurement angles;
  angles.stamp = Stamp{9 * kSecond};
  angles.receiver = RobotIndex(std::size_t{1});
  angles.transmitter.robot = RobotIndex(std::size_t{0});
  angles.paths = {{0.5, std::nullopt, 0.1, 0}};
  mission.aoa_measurements = {angles};
  PoseMatch match;
  match.robot_i = RobotIndex(std::size_t{1});
  match.robot_j = RobotIndex(std::size_t{0});
  match.stamp_i = Stamp{20 * kSecond};
  match.stamp_j = Stamp{21 * kSecond};
  match.covariance = isotropic_covariance(0.1, 0.1);
  mission.matches = {match};
  return mission;
}

MissionLogs logs_of_circling(double seconds = 200) { return logs_of(circling(seconds), KeyframeParams()); }

std::string fingerprint_of(const LoggedMission& logged) {
  std::string text;
  for (const RobotLog& log : logs_of(logged.mission, KeyframeParams()).robots) text += log.bytes();
  return text;
}

TEST(MissionLogs, SayWhatTheMissionSays) {
  const Mission mission = circling();
  TeamLog team;
  for (const RobotLog& log : logs_of_circling().robots) EXPECT_TRUE(team.accept(log.bytes()).is_whole());
  const LoggedMission logged = mission_of(team);
  EXPECT_TRUE(logged.notes.empty()) << logged.notes.front();
  const Mission& read = logged.mission;
  ASSERT_EQ(read.robots.size(), 2U);
  EXPECT_EQ(read.robots[0].id, "a");
  EXPECT_EQ(read.ranges.size(), mission.ranges.size());
  EXPECT_EQ(read.robots[read.ranges[0].i.robot.index()].id, "b");
  EXPECT_EQ(read.robots[read.aoa_measurements[0].receiver.index()].id, "a");
  EXPECT_EQ(read.matches[0].stamp_j, mission.matches[0].stamp_j);
  EXPECT_EQ(read.access_points.size(), 1U) << "the other one was never heard";
  EXPECT_EQ(read.robots[0].fixes.size(), 1U);
  EXPECT_LT(read.robots[0].odometry.size(), mission.robots[1].odometry.size() / 2);
  for (const Robot& robot : read.robots) {
    const Trajectory<SE3>& odometry = mission.robots[robot.id == "b" ? 0 : 1].odometry;
    for (const auto& row : odometry)
      EXPECT_LT(((*robot.odometry.at(row.stamp)).inverse() * row.pose).log().norm(), 0.06);
    EXPECT_LT((robot.odometry.back().pose.inverse() * odometry.back().pose).log().norm(), 1e-4);
  }
}

TEST(MissionLogs, SayWhatScansMeasured) {
  const Mission mission = circling();
  ScannedRecords scanned;
  scanned.closures = {{RobotIndex(1), RobotIndex(1), Stamp{8 * kSecond}, Stamp{40 * kSecond}, SE3(),
                       isotropic_covariance(0.1, 0.1), 0.9, 0.01},
                      {RobotIndex(0), RobotIndex(1), Stamp{5 * kSecond}, Stamp{6 * kSecond},
                       lift(SE2({1, 0}, 0)), isotropic_covariance(0.1, 0.1), 0.8}};
  scanned.places = {{RobotIndex(1), Stamp{7 * kSecond}, {0, true, 40, 1, 1, 3, {0, 1, 1}}}};
  TeamLog team;
  for (const RobotLog& log : logs_of(mission, KeyframeParams(), scanned).robots) team.add(log);
  const LoggedMission logged = mission_of(team);
  ASSERT_EQ(logged.closures.size(), 2U);
  EXPECT_EQ(logged.mission.matches.size(), mission.matches.size());
  EXPECT_EQ(logged.mission.robots[logged.closures[0].robot_i.index()].id, "b");
  EXPECT_NEAR(logged.closures[0].inlier_ratio, 0.8, 1e-7);
  EXPECT_FALSE(logged.closures[0].doubt);
  EXPECT_NEAR(*logged.closures[1].doubt, 0.01, 1e-9);
  std::size_t keyframes = 0;
  for (const auto& [number, bytes] : team.robots().at("a").records) {
    const auto record = decode_record(bytes);
    if (const auto* keyframe = std::get_if<KeyframeRecord>(&*record))
      if (keyframe->stamp <= Stamp{7 * kSecond}) ++keyframes;
    if (const auto* place = std::get_if<DescriptorRecord>(&*record)) {
      EXPECT_EQ(place->keyframe + 1, keyframes);
    }
    if (const auto* closure = std::get_if<ClosureRecord>(&*record); closure && closure->inlier_ratio) {
      EXPECT_GE(keyframes, 1U);
    }
  }
}

TEST(MissionLogs, TheLastAmendmentHolds) {
  RobotLog log = logs_of_circling(20).robots[1];
  const auto say = [&](std::uint32_t first, std::vector<AmendedStep> steps) {
    log.records.push_back(encode(AmendmentRecord{first, std::move(steps)}));
  };
  const SE3 step = lift(SE2({0.5, 0}, 0));
  say(1, {{lift(SE2({9, 0}, 0)), {}}, {step, isotropic_covariance(0.3, 0.1)}});
  say(1, {{step, {}}});
  TeamLog team;
  team.add(log);
  const Robot robot = mission_of(team).mission.robots[0];
  const auto moved = [&](std::size_t k) {
    return (robot.odometry.at(robot.keyframes[k - 1])->inverse() * *robot.odometry.at(robot.keyframes[k]));
  };
  for (const std::size_t k : {1U, 2U}) EXPECT_LT((moved(k).inverse() * step).log().norm(), 1e-6);
  EXPECT_GT((moved(3).inverse() * step).log().norm(), 0.1);
  const auto covariance = odometry_between<SE3>(robot, robot.keyframes[1], robot.keyframes[2]).covariance;
  EXPECT_NEAR(covariance(0, 0), 0.09, 1e-4);
}

TEST(MissionLogs, PutRobotsInTheOrderOfTheirNamesOrNumbers) {
  const auto order = [](const std::vector<std::string>& ids) {
    TeamLog team;
    for (const std::string& id : ids) {
      RobotLog log = logs_of_circling(20).robots[1];
      log.robot = id;
      team.add(log);
    }
    std::string text;
    for (const Robot& robot : mission_of(team).mission.robots) text += robot.id + " ";
    return text;
  };
  EXPECT_EQ(order({"r10", "r2", "r1"}), "r1 r2 r10 ");
  EXPECT_EQ(order({"r10", "r2", "s1"}), "r10 r2 s1 ");
  EXPECT_EQ(order({"f91", "f8a", "f100"}), "f100 f8a f91 ");
  EXPECT_EQ(order({"bob", "alice"}), "alice bob ");
}

TEST(ByLogs, KeepsTheOrderOfRobotsAndWhatNoLogSays) {
  Mission mission = circling();
  mission.name = "circles";
  mission.robots[0].inertial.resize(3);
  mission.robots.push_back({});
  mission.robots.back().id = "parked";
  mission.robots.back().odometry = Trajectory<SE3>({{Stamp{5}, SE3()}});
  const LoggedMission logged = by_logs(mission, KeyframeParams());
  const Mission& read = logged.mission;
  EXPECT_EQ(read.name, "circles");
  ASSERT_EQ(read.robots.size(), 3U);
  EXPECT_EQ(read.robots[0].id, "b");
  EXPECT_EQ(read.robots[0].inertial.size(), 3U);
  EXPECT_EQ(read.robots[2].odometry.size(), 1U);
  ASSERT_EQ(read.ranges.size(), mission.ranges.size());
  EXPECT_EQ(read.ranges[0].i.robot, RobotIndex(0));
  EXPECT_EQ(read.ranges[0].j.robot, RobotIndex(1));
  EXPECT_EQ(read.aoa_measurements[0].receiver, RobotIndex(1));
  EXPECT_EQ(read.matches[0].robot_i, RobotIndex(1));
  EXPECT_LT(read.robots[0].odometry.size(), mission.robots[0].odometry.size() / 2);
}

TEST(TeamLog, IsASetWhateverTheOrderAndRepetition) {
  const MissionLogs logs = logs_of_circling();
  TeamLog once, often;
  for (const RobotLog& log : logs.robots) once.accept(log.bytes());
  for (const std::size_t r : {1U, 0U}) {
    const RobotLog& log = logs.robots[r];
    const std::size_t half = log.records.size() / 2;
    EXPECT_GT(often.accept(log.bytes(half)).records, 0U);
    EXPECT_GT(often.accept(log.bytes(half / 2)).repeated, 0U);
    often.accept(log.bytes() + log.bytes());
  }
  EXPECT_EQ(fingerprint_of(mission_of(once)), fingerprint_of(mission_of(often)));
}

TEST(TeamLog, SaysWhatIsMissingAndKeepsTheRest) {
  const MissionLogs logs = logs_of_circling();
  const RobotLog& log = logs.robots[1];
  TeamLog team;
  team.accept(logs.robots[0].bytes());
  const std::size_t count = log.records.size();
  ASSERT_GT(count, 150U);
  team.accept(log.bytes(0, count / 2));
  team.accept(log.bytes(count / 2 + 60));
  ASSERT_EQ(team.robots().at("a").gaps().size(), 1U);
  EXPECT_EQ(team.robots().at("a").gaps()[0].first, count / 2);
  EXPECT_EQ(team.robots().at("a").gaps()[0].second, count / 2 + 59);
  const LoggedMission logged = mission_of(team);
  ASSERT_EQ(logged.notes.size(), 2U);
  EXPECT_NE(logged.notes[0].find("are missing"), std::string::npos);
  EXPECT_NE(logged.notes[1].find("the motion is unknown"), std::string::npos);
  double widest = 0;
  for (const OdometryStepNoise& step : logged.mission.robots[0].odometry_noise.steps)
    widest = std::max(widest, step.covariance_per_s(0, 0) * seconds_between(step.begin, step.end));
  EXPECT_GT(widest, 100) << "m^2";
  const auto covariance_until = [](const Robot& robot, double seconds) {
    return odometry_between<SE3>(robot, robot.odometry.front().stamp, Stamp::from_seconds(seconds))
        .covariance;
  };
  const Mission whole = circling();
  EXPECT_NEAR(covariance_until(logged.mission.robots[0], 50)(0, 0),
              covariance_until(whole.robots[1], 50)(0, 0), 0.02 * covariance_until(whole.robots[1], 50)(0, 0))
      << "as before where no keyframe is missing";
}

TEST(TeamLog, LeavesOutRobotsWhoseLogsAreNotThere) {
  TeamLog team;
  team.accept(logs_of_circling().robots[0].bytes());
  const LoggedMission logged = mission_of(team);
  EXPECT_EQ(logged.mission.ranges.size(), 100U) << "those to the anchor";
  ASSERT_EQ(logged.notes.size(), 1U);
  EXPECT_NE(logged.notes[0].find("measurements to a are left out"), std::string::npos);
}

TEST(TeamLog, RefusesAnotherRecordingOfTheSameRobot) {
  TeamLog team;
  team.accept(logs_of_circling(200).robots[0].bytes());
  const Acceptance other = team.accept(logs_of_circling(150).robots[0].bytes());
  EXPECT_EQ(other.records, 0U);
  ASSERT_FALSE(other.refusals.empty());
  EXPECT_NE(other.refusals[0].find("another recording"), std::string::npos);
}

TEST(TeamLog, SkipsWhatIsDamaged) {
  const RobotLog log = logs_of_circling().robots[0];
  std::string bytes = log.bytes();
  TeamLog whole;
  const std::size_t all = whole.accept(bytes).records;
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  TeamLog team;
  const Acceptance damaged = team.accept(bytes);
  EXPECT_GE(damaged.refused, 1U);
  EXPECT_GT(damaged.records, 0U);
  EXPECT_LT(damaged.records, all);
  TeamLog cut;
  EXPECT_GT(cut.accept(log.bytes().substr(0, bytes.size() - 3)).records, 0U);
  EXPECT_FALSE(cut.accept("no log at all").is_whole());
  EXPECT_THROW(mission_of(TeamLog()), std::runtime_error);
}

/// A robot's name becomes that of a file.
TEST(TeamLog, RefusesNamesThatAreNone) {
  const std::vector<std::string> records = logs_of_circling().robots[0].records;
  for (const char* name : {"", "../b", "a/b", "a\nb"}) {
    TeamLog team;
    EXPECT_FALSE(team.accept(RobotLog{name, records}.bytes()).is_whole()) << name;
    EXPECT_TRUE(team.robots().empty());
  }
}

/// Headers of chunks, each of which claims what follows: the worst for a reader that starts again at each.
TEST(TeamLog, GivesUpOnWhatNeverEnds) {
  std::string bytes;
  while (bytes.size() < 1'000'000) bytes += std::string("RSL2\1a", 6) + std::string(4, '\0') + '\0' + '\x7f';
  TeamLog team;
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(team.accept(bytes).records, 0U);
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), 5)
      << "not quadratic";
}

}  // namespace
}  // namespace radioslam
