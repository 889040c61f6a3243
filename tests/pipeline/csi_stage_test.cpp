// A simulated room's captures through the stage that measures angles, against the truth.
#include "radioslam/pipeline/csi_stage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "radioslam/base/parallel.hpp"
#include "radioslam/geometry/so3.hpp"
#include "radioslam/sim/csi_room.hpp"

namespace radioslam {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180;

CsiRoomParams open_room() {
  CsiRoomParams params;
  params.robots = 2;
  params.inner_walls = 0;
  params.most_bounces = 1;
  params.drives.turns_per_robot = 3;
  return params;
}

const Simulation& open_mission() {
  static const Simulation simulation = simulate_csi_room(open_room(), 4);
  return simulation;
}

const MeasuredCsi& open_measurements() {
  static const MeasuredCsi measured = measure_csi(open_mission().mission, {}, {});
  return measured;
}

double apart_rad(double a, double b) { return std::abs(std::remainder(a - b, 2 * std::numbers::pi)); }

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
  ASSERT_EQ(measured.notes.size(), 2U);
  EXPECT_NE(measured.notes[0].find("channel"), std::string::npos);
}

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
