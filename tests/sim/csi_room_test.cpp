#include "radioslam/sim/scenarios/csi_room.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace radioslam {
namespace {

CsiRoomParams short_talk() {
  CsiRoomParams params;
  params.drives.turns_per_robot = 1;
  params.packet_rate_hz = 40;
  return params;
}

bool same_packet(const CsiPacket& a, const CsiPacket& b) {
  return a.stamp == b.stamp && a.clock_us == b.clock_us && a.sender == b.sender && a.counter == b.counter &&
         a.rssi == b.rssi && a.channel == b.channel;
}

bool same_recordings(const Simulation& a, const Simulation& b) {
  for (std::size_t r = 0; r < a.mission.robots.size(); ++r) {
    const auto& x = a.mission.robots[r];
    const auto& y = b.mission.robots[r];
    if (x.odometry.back().pose.translation() != y.odometry.back().pose.translation()) return false;
    const auto& p = x.csi->captures.at(0).packets;
    const auto& q = y.csi->captures.at(0).packets;
    if (!std::equal(p.begin(), p.end(), q.begin(), q.end(),
                    [](const auto& m, const auto& n) { return same_packet(m, n); }))
      return false;
  }
  return a.mission.ranges.size() == b.mission.ranges.size() &&
         a.mission.ranges.front().range_m == b.mission.ranges.front().range_m;
}

TEST(CsiRoom, SameSeedSameMission) {
  const auto one = simulate_csi_room(short_talk(), 3);
  EXPECT_TRUE(same_recordings(one, simulate_csi_room(short_talk(), 3)));
  EXPECT_FALSE(same_recordings(one, simulate_csi_room(short_talk(), 4)));
}

TEST(CsiRoom, EveryLegIsReceivedByAllOthersAndAnswered) {
  const auto [mission, truth] = simulate_csi_room(short_talk(), 1);
  ASSERT_EQ(mission.robots.size(), 3U);
  EXPECT_EQ(mission.ranges.size(), 18U);
  std::set<std::uint64_t> addresses;
  std::map<std::pair<std::uint64_t, std::uint64_t>, std::set<std::uint32_t>>
      counters;  // of (sender, receiver)
  for (const Robot& robot : mission.robots) {
    ASSERT_TRUE(robot.csi && robot.csi->address);
    EXPECT_TRUE(addresses.insert(robot.csi->address->value).second);
    EXPECT_EQ(robot.csi->carrier_hz, 5.54e9);
    ASSERT_EQ(robot.csi->captures.size(), 1U);
    for (const CsiPacket& packet : robot.csi->captures[0].packets)
      EXPECT_TRUE(
          counters[std::pair(packet.sender->value, robot.csi->address->value)].insert(*packet.counter).second)
          << "no counter twice from one sender";
  }
  EXPECT_EQ(counters.size(), 6U);
  for (const auto& [ends, heard] : counters) {
    const auto& back = counters[std::pair(ends.second, ends.first)];
    std::vector<std::uint32_t> both;
    std::set_intersection(heard.begin(), heard.end(), back.begin(), back.end(), std::back_inserter(both));
    EXPECT_GT(static_cast<double>(both.size()), 0.92 * static_cast<double>(heard.size()));
    EXPECT_GT(heard.size(), 300U);
  }
}

TEST(CsiRoom, ManyAntennasAndARoomWithoutInnerWalls) {
  CsiRoomParams params = short_talk();
  params.antennas = 3;
  params.inner_walls = 0;
  params.channel = "6";
  const auto [mission, truth] = simulate_csi_room(params, 1);
  const auto& csi = *mission.robots[1].csi;
  EXPECT_EQ(csi.carrier_hz, 2.437e9);
  ASSERT_EQ(csi.antennas_m.size(), 3U);
  EXPECT_EQ(csi.antennas_m[0].y(), -csi.antennas_m[2].y());
  EXPECT_EQ(csi.captures[0].packets[0].channel.rows(), 3);
  EXPECT_EQ(walls_of(params).size(), 4U);
}

TEST(CsiRoom, RobotsDriveInTheRoomAndTheOdometryHardlyDrifts) {
  const auto [mission, truth] = simulate_csi_room(short_talk(), 5);
  for (std::size_t r = 0; r < 3; ++r) {
    for (const auto& [stamp, pose] : truth.robots[r].poses) {
      EXPECT_GT(pose.translation().x(), 0);
      EXPECT_LT(pose.translation().x(), 16);
      EXPECT_GT(pose.translation().y(), 0);
      EXPECT_LT(pose.translation().y(), 11);
    }
    const auto& poses = truth.robots[r].poses;
    const SE3 moved = poses.front().pose.inverse() * poses.back().pose;
    EXPECT_LT((moved.inverse() * mission.robots[r].odometry.back().pose).translation().norm(), 0.03);
  }
}

/// One parameter at a time at an end of its range, unless that only makes the mission long.
TEST(CsiRoom, RunsAtTheEndsOfItsRanges) {
  const std::set<std::string_view> long_at_the_end{"turns_per_robot", "max_leg_m",        "min_leg_m",
                                                   "robots",          "odometry_rate_hz", "draws",
                                                   "ranges_per_pair", "pause_s"};
  CsiRoomParams params = short_talk();
  params.robots = 2;
  params.packet_rate_hz = 2;
  params.odometry.odometry_rate_hz = 2;
  CsiRoomParams::visit_fields(params, [&](const Field& field, auto& value) {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (std::is_arithmetic_v<Value>) {
      const Value before = value;
      for (const double end : {field.minimum, field.maximum}) {
        if (end == field.maximum && long_at_the_end.contains(field.name)) continue;
        value = static_cast<Value>(end);
        const auto [mission, truth] = simulate_csi_room(params, 4);
        for (const Robot& robot : mission.robots) {
          ASSERT_TRUE(robot.odometry.back().pose.translation().allFinite()) << field.name << " = " << end;
          for (const CsiCapture& capture : robot.csi->captures)
            for (const CsiPacket& packet : capture.packets)
              ASSERT_TRUE(packet.channel.allFinite() && packet.channel.cwiseAbs().maxCoeff() < 181)
                  << field.name << " = " << end;
        }
      }
      value = before;
    }
  });
}

}  // namespace
}  // namespace radioslam
