// A simulated room's captures through the stage that measures angles, against the truth.
#include "radioslam/pipeline/csi_stage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "radio/simulated_exchange.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/geometry/so3.hpp"
#include "radioslam/pipeline/csi_arrivals.hpp"
#include "radioslam/sim/csi_room.hpp"

namespace radioslam {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180;

CsiRoomParams room_without_walls() {
  CsiRoomParams params;
  params.robots = 2;
  params.inner_walls = 0;
  params.most_bounces = 1;
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

/// Of the transmitter's antenna seen from the receiver's body.
double true_azimuth_rad(const Simulation& simulation, const ArrivalMeasurement& measured) {
  const auto& robots = simulation.truth.robots;
  const auto receiver = *robots[measured.receiver.index()].poses.at(measured.stamp);
  const auto transmitter = *robots[measured.transmitter.robot.index()].poses.at(measured.stamp);
  const Eigen::Vector3d way = receiver.inverse() * (transmitter * measured.transmitter.lever_arm_m);
  return std::atan2(way.y(), way.x());
}

TEST(CsiStage, PointsAtTheOtherRobots) {
  const MeasuredCsi& measured = open_measurements();
  ASSERT_GE(measured.arrivals.size(), 6U) << "a leg of each robot is at least a metre";
  std::size_t right = 0;
  for (const ArrivalMeasurement& arrival : measured.arrivals)
    if (apart_rad(arrival.paths.front().azimuth_rad, true_azimuth_rad(open_mission(), arrival)) <
        10 * kDegree_rad)
      ++right;
  EXPECT_GT(static_cast<double>(right), 0.8 * static_cast<double>(measured.arrivals.size()));
}

TEST(CsiStage, KeepsTheOrderOfTimeAndAProfilePerMeasurement) {
  const MeasuredCsi& measured = open_measurements();
  ASSERT_EQ(measured.profiles.size(), measured.arrivals.size());
  for (std::size_t k = 0; k < measured.arrivals.size(); ++k) {
    EXPECT_EQ(measured.profiles[k].stamp, measured.arrivals[k].stamp);
    EXPECT_NE(measured.profiles[k].receiver, measured.profiles[k].transmitter);
    if (k > 0) {
      EXPECT_LE(measured.arrivals[k - 1].stamp, measured.arrivals[k].stamp);
    }
  }
}

// The profile is of directions from the array's centre, the peak of those from the body: a source five metres
// off puts them a few degrees apart.
TEST(CsiStage, ProfilesAreInTheBodyFrame) {
  std::size_t near = 0;
  double most_turned = 0;
  for (std::size_t k = 0; k < open_measurements().profiles.size(); ++k) {
    const MeasuredArrivalResult& profile = open_measurements().profiles[k];
    const auto most = std::max_element(profile.profile.begin(), profile.profile.end());
    EXPECT_EQ(*most, 1);
    const double azimuth_rad = -std::numbers::pi + 2 * std::numbers::pi *
                                                       static_cast<double>(most - profile.profile.begin()) /
                                                       static_cast<double>(profile.profile.size());
    if (apart_rad(azimuth_rad, profile.peaks.front().azimuth_rad) < 8 * kDegree_rad) ++near;
    const std::size_t robot = open_measurements().arrivals[k].receiver.index();
    most_turned = std::max(most_turned,
                           std::abs(open_mission().mission.robots[robot].odometry.at(profile.stamp)->yaw()));
  }
  EXPECT_EQ(near, open_measurements().profiles.size());
  EXPECT_GT(most_turned, 0.5) << "or the test shows nothing";
}

/// The same mission whose odometry begins in another frame, turned about.
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
  const MeasuredCsi there = measure_csi(turned(open_mission().mission, 90 * kDegree_rad), {}, {});
  ASSERT_EQ(here.arrivals.size(), there.arrivals.size());
  for (std::size_t k = 0; k < here.arrivals.size(); ++k) {
    EXPECT_EQ(here.arrivals[k].stamp, there.arrivals[k].stamp);
    EXPECT_LT(
        apart_rad(here.arrivals[k].paths.front().azimuth_rad, there.arrivals[k].paths.front().azimuth_rad),
        1 * kDegree_rad)
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
  ASSERT_EQ(one.arrivals.size(), two.arrivals.size());
  for (std::size_t k = 0; k < one.arrivals.size(); ++k) {
    EXPECT_EQ(one.profiles[k].profile, two.profiles[k].profile);
    ASSERT_EQ(one.arrivals[k].paths.size(), two.arrivals[k].paths.size());
    for (std::size_t p = 0; p < one.arrivals[k].paths.size(); ++p) {
      EXPECT_EQ(one.arrivals[k].paths[p].azimuth_rad, two.arrivals[k].paths[p].azimuth_rad);
      EXPECT_EQ(one.arrivals[k].paths[p].sigma_rad, two.arrivals[k].paths[p].sigma_rad);
    }
  }
}

TEST(CsiStage, OfAMissionWithoutCapturesIsNothing) {
  Mission mission = open_mission().mission;
  for (Robot& robot : mission.robots) robot.csi.reset();
  const MeasuredCsi measured = measure_csi(mission, {}, {});
  EXPECT_TRUE(measured.arrivals.empty());
  EXPECT_TRUE(measured.notes.empty());
}

TEST(CsiStage, SaysThatTheChannelIsMissing) {
  Mission mission = open_mission().mission;
  for (Robot& robot : mission.robots) {
    robot.csi->carrier_hz = 0;
    for (CsiCapture& capture : robot.csi->captures) capture.carrier_hz.reset();
  }
  const MeasuredCsi measured = measure_csi(mission, {}, {});
  EXPECT_TRUE(measured.arrivals.empty());
  ASSERT_GE(measured.notes.size(), 2U);
  EXPECT_NE(measured.notes[0].find("channel"), std::string::npos);
}

bool has_note(const MeasuredCsi& measured, const std::string& words) {
  return std::any_of(measured.notes.begin(), measured.notes.end(),
                     [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

TEST(CsiStage, SaysThatACardsAddressIsMissing) {
  Mission mission = open_mission().mission;
  mission.robots[1].csi->address.reset();
  const MeasuredCsi measured = measure_csi(mission, {}, {});
  EXPECT_TRUE(has_note(measured, "what others heard of robot b took no part: mission.yaml has no mac"));
  EXPECT_TRUE(has_note(measured, "of robot a's captures took no part: no robot's card has the mac"));
  for (const ArrivalMeasurement& arrival : measured.arrivals) EXPECT_EQ(arrival.receiver.index(), 1U);
}

/// b's card heard something else than a's packets: the same counters, other phases.
Mission with_anothers_answers(Mission mission) {
  Rng rng(3);
  for (CsiCapture& capture : mission.robots[1].csi->captures)
    for (CsiPacket& packet : capture.packets)
      packet.channel *= std::polar(1.0F, static_cast<float>(rng.uniform(0, 2 * std::numbers::pi)));
  return mission;
}

TEST(CsiStage, TakesNoAnswersOfAnotherEnd) {
  const MeasuredCsi measured = measure_csi(with_anothers_answers(open_mission().mission), {}, {});
  EXPECT_TRUE(measured.arrivals.empty());
  EXPECT_TRUE(has_note(measured, "robot a did not measure where it heard b from on"));
  EXPECT_TRUE(has_note(measured, "their phases do not agree"));
}

TEST(CsiStage, TakesNoElevationFromALevelWayAndKeepsWhatItTook) {
  Mission mission = open_mission().mission;
  mission.dimension = 3;
  const MeasuredCsi measured = measure_csi(mission, {}, {});
  ASSERT_EQ(measured.arrivals.size(), open_measurements().arrivals.size());
  for (std::size_t k = 0; k < measured.arrivals.size(); ++k) {
    ASSERT_EQ(measured.profiles[k].paths.size(), measured.arrivals[k].paths.size());
    for (std::size_t p = 0; p < measured.arrivals[k].paths.size(); ++p) {
      EXPECT_FALSE(measured.arrivals[k].paths[p].elevation_rad);
      EXPECT_EQ(measured.profiles[k].paths[p].azimuth_rad, measured.arrivals[k].paths[p].azimuth_rad);
    }
  }
}

/// A robot that drives by fits and starts, its captures by a clock that is late, and one that stands and
/// answers.
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
  EXPECT_TRUE(has_note(late, "robot a's captures were moved by -0."));
  EXPECT_FALSE(has_note(right, "captures were moved"));
  CsiStageParams as_is;
  as_is.clock_offset = false;
  const MeasuredCsi left = measure_csi(stop_and_go(0.3), as_is, {});
  EXPECT_FALSE(has_note(left, "captures were moved"));
  ASSERT_FALSE(right.arrivals.empty());
  ASSERT_EQ(late.arrivals.size(), right.arrivals.size());
  ASSERT_EQ(left.arrivals.size(), right.arrivals.size());
  const auto off_rad = [&](const MeasuredCsi& of) {
    double sum = 0;
    for (std::size_t k = 0; k < right.arrivals.size(); ++k)
      sum += apart_rad(of.arrivals[k].paths.front().azimuth_rad, right.arrivals[k].paths.front().azimuth_rad);
    return sum;
  };
  EXPECT_LT(off_rad(late), 0.5 * off_rad(left));
}

TEST(CsiStage, LeavesClocksThatAgree) { EXPECT_FALSE(has_note(open_measurements(), "captures were moved")); }

TEST(CsiStage, SaysWhereTheEstimateHasTheTransmitter) {
  MeasuredArrivalResult profile;
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
  std::vector<MeasuredArrivalResult> profiles{profile};
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
