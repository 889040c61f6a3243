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

LoggedMission continued(bool odometry_goes_on) {
  RobotLog log{"a", {}};
  const KnownLog said = before();
  for (const auto& [number, record] : said.records) log.records.push_back(record);
  ResumedLog resumed(said, odometry_goes_on);
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

}  // namespace
}  // namespace radioslam
