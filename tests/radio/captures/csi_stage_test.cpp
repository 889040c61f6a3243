// The AoA stage on a simulated room's captures, compared with the truth.
#include "radioslam/radio/captures/csi_stage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "radio/aoa/simulated_exchange.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/base/units.hpp"
#include "radioslam/geometry/so3.hpp"
#include "radioslam/radio/captures/csi_aoa.hpp"
#include "radioslam/sim/scenarios/csi_room.hpp"

namespace radioslam {
namespace {

CsiRoomParams room_without_walls() {
  CsiRoomParams params;
  params.robots = 2;
  params.inner_walls = 0;
  params.max_bounces = 1;
  params.drives.turns_per_robot = 3;
  return params;
}

const Simulation& open_mission() {
  static const Simulation simulation = simulate_csi_room(room_without_walls(), 4);
  return simulation;
}

const MeasuredCsi& open_measurements() {
  static const MeasuredCsi measured = measure_csi(open_mission().mission, {}, {});
  return measured;
}

using waves::apart_rad;

/// Direction of the transmitter's antenna seen from the receiver's body.
double true_azimuth_rad(const Simulation& simulation, const AoaMeasurement& measured) {
  const auto& robots = simulation.truth.robots;
  const auto receiver = *robots[measured.receiver.index()].poses.at(measured.stamp);
  const auto transmitter = *robots[measured.transmitter.robot.index()].poses.at(measured.stamp);
  const Eigen::Vector3d way = receiver.inverse() * (transmitter * measured.transmitter.lever_arm_m);
  return std::atan2(way.y(), way.x());
}

TEST(CsiStage, PointsAtTheOtherRobots) {
  const MeasuredCsi& measured = open_measurements();
  ASSERT_GE(measured.aoa_measurements.size(), 6U) << "a leg of each robot is at least a metre";
  std::size_t right = 0;
  for (const AoaMeasurement& measurement : measured.aoa_measurements)
    if (apart_rad(measurement.paths.front().azimuth_rad, true_azimuth_rad(open_mission(), measurement)) <
        10 * kRadiansPerDegree)
      ++right;
  EXPECT_GT(static_cast<double>(right), 0.8 * static_cast<double>(measured.aoa_measurements.size()));
}

TEST(CsiStage, KeepsTheOrderOfTimeAndAProfilePerMeasurement) {
  const MeasuredCsi& measured = open_measurements();
  ASSERT_EQ(measured.profiles.size(), measured.aoa_measurements.size());
  for (std::size_t k = 0; k < measured.aoa_measurements.size(); ++k) {
    EXPECT_EQ(measured.profiles[k].stamp, measured.aoa_measurements[k].stamp);
    EXPECT_NE(measured.profiles[k].receiver, measured.profiles[k].transmitter);
    if (k > 0) {
      EXPECT_LE(measured.aoa_measurements[k - 1].stamp, measured.aoa_measurements[k].stamp);
    }
  }
}

// Profiles are seen from the array's centre, peaks from the body: for a source at five metres they differ by
// a few degrees.
TEST(CsiStage, ProfilesAreInTheBodyFrame) {
  std::size_t near = 0;
  double most_turned = 0;
  for (std::size_t k = 0; k < open_measurements().profiles.size(); ++k) {
    const MeasuredAoaResult& profile = open_measurements().profiles[k];
    const auto most = std::max_element(profile.profile.begin(), profile.profile.end());
    EXPECT_EQ(*most, 1);
    const double azimuth_rad = -std::numbers::pi + 2 * std::numbers::pi *
                                                       static_cast<double>(most - profile.profile.begin()) /
                                                       static_cast<double>(profile.profile.size());
    if (apart_rad(azimuth_rad, profile.peaks.front().azimuth_rad) < 8 * kRadiansPerDegree) ++near;
    const std::size_t robot = open_measurements().aoa_measurements[k].receiver.index();
    most_turned = std::max(most_turned,
                           std::abs(open_mission().mission.robots[robot].odometry.at(profile.stamp)->yaw()));
  }
  EXPECT_EQ(near, open_measurements().profiles.size());
  EXPECT_GT(most_turned, 0.5) << "or the test shows nothing";
}

/// The same mission with the odometry expressed in another, rotated frame.
Mission turned(Mission mission, double yaw_rad) {
  for (Robot& robot : mission.robots) {
    std::vector<StampedPose<SE3>> poses;
    for (const auto& [stamp, pose] : robot.odometry)
      poses.push_back({stamp, SE3({3, -2, 0}, so3_exp({0, 0, yaw_rad})) * pose});
    robot.odometry = Trajectory<SE3>(std::move(poses));
  }
  return mission;
}

TEST(CsiStage, DoesNotCareForTheOdometrysFrame) {
  const MeasuredCsi& here = open_measurements();
  const MeasuredCsi there = measure_csi(turned(open_mission().mission, 90 * kRadiansPerDegree), {}, {});
  ASSERT_EQ(here.aoa_measurements.size(), there.aoa_measurements.size());
  for (std::size_t k = 0; k < here.aoa_measurements.size(); ++k) {
    EXPECT_EQ(here.aoa_measurements[k].stamp, there.aoa_measurements[k].stamp);
    EXPECT_LT(apart_rad(here.aoa_measurements[k].paths.front().azimuth_rad,
                        there.aoa_measurements[k].paths.front().azimuth_rad),
              1 * kRadiansPerDegree)
        << k;
    std::size_t alike = 0;
    const auto& a = here.profiles[k].profile;
    const auto& b = there.profiles[k].profile;
    for (std::size_t at = 0; at < a.size(); ++at)
      if (std::abs(a[at] - b[at]) < 0.05F) ++alike;
    EXPECT_GT(alike, a.size() * 9 / 10) << k;
  }
}

TEST(CsiStage, IsTheSameForOneThreadAndTwo) {
  set_thread_count(1);
  const MeasuredCsi one = measure_csi(open_mission().mission, {}, {});
  set_thread_count(2);
  const MeasuredCsi two = measure_csi(open_mission().mission, {}, {});
  set_thread_count(0);
  ASSERT_EQ(one.aoa_measurements.size(), two.aoa_measurements.size());
  for (std::size_t k = 0; k < one.aoa_measurements.size(); ++k) {
    EXPECT_EQ(one.profiles[k].profile, two.profiles[k].profile);
    ASSERT_EQ(one.aoa_measurements[k].paths.size(), two.aoa_measurements[k].paths.size());
    for (std::size_t p = 0; p < one.aoa_measurements[k].paths.size(); ++p) {
      EXPECT_EQ(one.aoa_measurements[k].paths[p].azimuth_rad, two.aoa_measurements[k].paths[p].azimuth_rad);
      EXPECT_EQ(one.aoa_measurements[k].paths[p].sigma_rad, two.aoa_measurements[k].paths[p].sigma_rad);
    }
  }
}

TEST(CsiStage, OfAMissionWithoutCapturesIsNothing) {
  Mission mission = open_mission().mission;
  for (Robot& robot : mission.robots) robot.csi.reset();
  const MeasuredCsi measured = measure_csi(mission, {}, {});
  EXPECT_TRUE(measured.aoa_measurements.empty());
  EXPECT_TRUE(measured.notes.empty());
}

TEST(CsiStage, NotesAMissingWifiChannel) {
  Mission mission = open_mission().mission;
  for (Robot& robot : mission.robots) {
    robot.csi->carrier_hz = 0;
    for (CsiCapture& capture : robot.csi->captures) capture.carrier_hz.reset();
  }
  const MeasuredCsi measured = measure_csi(mission, {}, {});
  EXPECT_TRUE(measured.aoa_measurements.empty());
  ASSERT_GE(measured.notes.size(), 2U);
  EXPECT_NE(measured.notes[0].find("channel"), std::string::npos);
}

bool has_note(const MeasuredCsi& measured, const std::string& words) {
  return std::any_of(measured.notes.begin(), measured.notes.end(),
                     [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

TEST(CsiStage, NotesAMissingMacAddress) {
  Mission mission = open_mission().mission;
  mission.robots[1].csi->address.reset();
  const MeasuredCsi measured = measure_csi(mission, {}, {});
  EXPECT_TRUE(has_note(measured, "packets sent by robot b were ignored: mission.yaml has no mac"));
  EXPECT_TRUE(
      has_note(measured, "of robot a's CSI captures were ignored: their sender's mac belongs to no robot"));
  for (const AoaMeasurement& measurement : measured.aoa_measurements)
    EXPECT_EQ(measurement.receiver.index(), 1U);
}

/// b's card received other packets than a's: the same counters, other phases.
Mission with_other_replies(Mission mission) {
  Rng rng(3);
  for (CsiCapture& capture : mission.robots[1].csi->captures)
    for (CsiPacket& packet : capture.packets)
      packet.channel *= std::polar(1.0F, static_cast<float>(rng.uniform(0, 2 * std::numbers::pi)));
  return mission;
}

TEST(CsiStage, TakesNoAnswersOfAnotherEnd) {
  const MeasuredCsi measured = measure_csi(with_other_replies(open_mission().mission), {}, {});
  EXPECT_TRUE(measured.aoa_measurements.empty());
  EXPECT_TRUE(has_note(measured, "robot a measured no angle of arrival of robot b in"));
  EXPECT_TRUE(has_note(measured, "phases of packets and replies do not agree"));
}

TEST(CsiStage, TakesNoElevationFromALevelPathAndKeepsTheAzimuths) {
  Mission mission = open_mission().mission;
  mission.dimension = 3;
  const MeasuredCsi measured = measure_csi(mission, {}, {});
  ASSERT_EQ(measured.aoa_measurements.size(), open_measurements().aoa_measurements.size());
  for (std::size_t k = 0; k < measured.aoa_measurements.size(); ++k) {
    ASSERT_EQ(measured.profiles[k].paths.size(), measured.aoa_measurements[k].paths.size());
    for (std::size_t p = 0; p < measured.aoa_measurements[k].paths.size(); ++p) {
      EXPECT_FALSE(measured.aoa_measurements[k].paths[p].elevation_rad);
      EXPECT_EQ(measured.profiles[k].paths[p].azimuth_rad, measured.aoa_measurements[k].paths[p].azimuth_rad);
    }
  }
}

/// A robot in stop-and-go motion whose captures are stamped late, and one that stands still and replies.
Mission stop_and_go(double late_s) {
  SimulatedExchange exchange;
  constexpr double kTurn_rad = 2 * std::numbers::pi;
  exchange.motion = [](double t_s) {
    return on_circle(0.6, 0.3 * (t_s - std::sin(kTurn_rad * t_s / 2) / kTurn_rad * 2));
  };
  exchange.paths = plane_wave_paths({{0.3, 0, -15, 3e-8}, {2.1, 0.2, -18, 5e-8}, {-1.5, 0, -20, 6e-8}});
  exchange.end_s = 12;
  exchange.cards.stamp_offset_s = late_s;
  SimulatedExchange::Captures heard = exchange.captures();
  const auto robot = [](const char* id, Trajectory<SE3> odometry, std::uint64_t address, CsiCapture capture) {
    Robot result;
    result.id = id;
    result.odometry = std::move(odometry);
    result.csi = CsiRecording{
        MacAddress{address}, SimulatedExchange::kCarrier_hz, {{0.1, 0.05, 0}}, {std::move(capture)}};
    return result;
  };
  Mission mission;
  mission.robots.push_back(robot("a", exchange.trajectory(), 0xa, std::move(heard.asker)));
  const SE3 stand(exchange.answerer_m, Eigen::Quaterniond::Identity());
  mission.robots.push_back(
      robot("b", Trajectory<SE3>({{Stamp::from_seconds(0), stand}, {Stamp::from_seconds(15), stand}}), 0xb,
            std::move(heard.answerer)));
  return mission;
}

TEST(CsiStage, FindsTheClockOffsetAndUndoesIt) {
  const MeasuredCsi late = measure_csi(stop_and_go(0.3), {}, {}), right = measure_csi(stop_and_go(0), {}, {});
  EXPECT_TRUE(has_note(late, "robot a's CSI captures were shifted by -0."));
  EXPECT_FALSE(has_note(right, "captures were shifted"));
  CsiStageParams as_is;
  as_is.clock_offset = false;
  const MeasuredCsi left = measure_csi(stop_and_go(0.3), as_is, {});
  EXPECT_FALSE(has_note(left, "captures were shifted"));
  ASSERT_FALSE(right.aoa_measurements.empty());
  ASSERT_EQ(late.aoa_measurements.size(), right.aoa_measurements.size());
  ASSERT_EQ(left.aoa_measurements.size(), right.aoa_measurements.size());
  const auto off_rad = [&](const MeasuredCsi& of) {
    double sum = 0;
    for (std::size_t k = 0; k < right.aoa_measurements.size(); ++k)
      sum += apart_rad(of.aoa_measurements[k].paths.front().azimuth_rad,
                       right.aoa_measurements[k].paths.front().azimuth_rad);
    return sum;
  };
  EXPECT_LT(off_rad(late), 0.5 * off_rad(left));
}

TEST(CsiStage, LeavesClocksThatAgree) {
  EXPECT_FALSE(has_note(open_measurements(), "captures were shifted"));
}

TEST(CsiStage, AddsTheEstimatedAzimuthOfTheTransmitter) {
  MeasuredAoaResult profile;
  profile.receiver = "a";
  profile.transmitter = "b";
  profile.stamp = Stamp::from_seconds(1);
  const auto robot = [](const char* id, const SE3& pose) {
    RobotResult result;
    result.id = id;
    result.placed = true;
    result.estimate = Trajectory<SE3>({{Stamp::from_seconds(0), pose}, {Stamp::from_seconds(2), pose}});
    return result;
  };
  std::vector<RobotResult> robots{robot("a", SE3({1, 1, 0}, so3_exp({0, 0, std::numbers::pi / 2}))),
                                  robot("b", SE3({1, 4, 0}, so3_exp({0, 0, 1})))};
  std::vector<MeasuredAoaResult> profiles{profile};
  add_estimated_azimuths(profiles, robots);
  ASSERT_TRUE(profiles[0].estimated_azimuth_rad);
  EXPECT_NEAR(*profiles[0].estimated_azimuth_rad, 0, 1e-12) << "straight ahead";
  robots[1].placed = false;
  profiles = {profile};
  add_estimated_azimuths(profiles, robots);
  EXPECT_FALSE(profiles[0].estimated_azimuth_rad);
}

}  // namespace
}  // namespace radioslam
