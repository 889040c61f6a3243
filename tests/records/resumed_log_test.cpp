#include "radioslam/records/resumed_log.hpp"

#include <gtest/gtest.h>

#include "radioslam/records/mission_of_logs.hpp"
#include "radioslam/records/record_codec.hpp"

namespace radioslam {
namespace {

SE3 forward(double m) { return SE3({m, 0, 0}, Eigen::Quaterniond::Identity()); }

FactsRecord facts() {
  FactsRecord of;
  of.lidar_range_m = of.lidar_view_rad = 1;
  return of;
}

KeyframeRecord keyframe(std::uint32_t number, double t_s, const SE3& T_before_this) {
  KeyframeRecord record;
  record.number = number;
  record.stamp = Stamp::from_seconds(t_s);
  record.T_before_this = T_before_this;
  return record;
}

/// Facts, and keyframes at 0, 1 and 2 m.
KnownLog before() {
  KnownLog log{1, {}};
  log.records[0] = encode(Record(facts()));
  for (std::uint32_t k = 0; k < 3; ++k)
    log.records[k + 1] = encode(Record(keyframe(k, k, k == 0 ? SE3() : forward(1))));
  return log;
}

/// What the new front end says: the odometry is at 10 and 11 m.
std::vector<std::string> after() {
  return {encode(Record(facts())), encode(Record(keyframe(0, 10, forward(10)))),
          encode(Record(keyframe(1, 11, forward(1)))),
          encode(Record(FixRecord{{1, Stamp::from_seconds(11), SE3()}, {5, 6, 7}, 1}))};
}

template <class Odometry>
LoggedMission continued(const Odometry& odometry) {
  RobotLog log{"a", {}};
  const KnownLog said = before();
  for (const auto& [number, record] : said.records) log.records.push_back(record);
  ResumedLog resumed(said, odometry);
  for (const std::string& record : after())
    if (auto more = resumed.continued(record)) log.records.push_back(*std::move(more));
  TeamLog team;
  team.add(log);
  return mission_of(team);
}

TEST(ResumedLog, FollowsAnOdometryThatWasNotStopped) {
  const LoggedMission logged = continued(true);
  EXPECT_TRUE(logged.notes.empty());
  const Trajectory<SE3>& odometry = logged.mission.robots[0].odometry;
  ASSERT_EQ(odometry.size(), 5U);
  EXPECT_NEAR(odometry.at(Stamp::from_seconds(10))->translation().x(), 10, 1e-6);
  EXPECT_NEAR(odometry.at(Stamp::from_seconds(11))->translation().x(), 11, 1e-6);
  ASSERT_EQ(logged.mission.robots[0].fixes.size(), 1U);
  EXPECT_EQ(logged.mission.robots[0].fixes[0].stamp, Stamp::from_seconds(11));
}

TEST(ResumedLog, DoesNotKnowTheMotionBetweenTwoOdometries) {
  const LoggedMission logged = continued(false);
  ASSERT_EQ(logged.notes.size(), 1U);
  EXPECT_NE(logged.notes[0].find("the motion is unknown"), std::string::npos) << logged.notes[0];
  const Trajectory<SE3>& odometry = logged.mission.robots[0].odometry;
  const auto a = odometry.at(Stamp::from_seconds(10)), b = odometry.at(Stamp::from_seconds(11));
  EXPECT_NEAR((a->inverse() * *b).translation().x(), 1, 1e-6);
}

/// Wheels that count 100 m more than the log says; the robot was at `last_s` when it last noted them.
OdometryBesideScans wheels(double last_s, const RecordedAtKeyframes& after) {
  OdometryNoise noise;
  noise.sigma_xy_per_sqrt_m = noise.sigma_yaw_per_sqrt_m_rad = 0.1;
  return {{{Stamp::from_seconds(last_s), forward(102)}}, after, noise};
}

TEST(ResumedLog, FollowsTheWheelsBesideScans) {
  const RecordedAtKeyframes after{{Stamp::from_seconds(10), forward(106)}};
  const LoggedMission logged = continued(wheels(2, after));
  EXPECT_TRUE(logged.notes.empty());
  const Robot& robot = logged.mission.robots[0];
  EXPECT_NEAR(robot.odometry.at(Stamp::from_seconds(10))->translation().x(), 6, 1e-4);
  ASSERT_EQ(robot.odometry_noise.steps.size(), 1U);
  const OdometryStepNoise& step = robot.odometry_noise.steps[0];
  // It has been seen at 1 m/s, so that it may have gone 8 m for these 4. Headings that are wrong on the way
  // move it aside: a random walk of the heading, integrated.
  const SE3::Jacobian covariance = step.covariance_per_s * seconds_between(step.begin, step.end);
  EXPECT_NEAR(covariance(0, 0), 0.08, 1e-3);
  EXPECT_NEAR(covariance(5, 5), 0.08, 1e-3);
  EXPECT_NEAR(covariance(1, 1), 0.08 + 0.02 * 4 * 4 * 4 / 3, 0.2);
  EXPECT_GT(covariance(1, 1), 0.3);
}

TEST(ResumedLog, DoesNotFollowWheelsOfAnotherKeyframe) {
  const RecordedAtKeyframes after{{Stamp::from_seconds(10), forward(106)}},
      later{{Stamp::from_seconds(11), forward(107)}};
  EXPECT_EQ(continued(wheels(1, after)).notes.size(), 1U);
  EXPECT_EQ(continued(wheels(2, later)).notes.size(), 1U);
}

TEST(ResumedLog, RecordedOdometryIsReadAsItWasKept) {
  const SE3 pose({1, -2, 0.5}, Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ())));
  const RecordedAtKeyframes read = decode_recorded(encode_recorded({Stamp::from_seconds(7), pose}));
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(read.begin()->first, Stamp::from_seconds(7));
  EXPECT_LT((read.begin()->second.inverse() * pose).log().norm(), 1e-4);
  EXPECT_TRUE(decode_recorded("").empty());
  EXPECT_TRUE(decode_recorded(encode(Record(facts()))).empty());
}

}  // namespace
}  // namespace radioslam
