// What a robot makes of its drivers' messages: samples in its body frame, and a line for what it cannot use.
#include "radioslam/ros_node/robot_samples.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "ros_node/arrivals.hpp"

namespace radioslam {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const SE3 kQuarterTurn({1, 0, 0.5},
                       Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ())));

TEST(RobotSamples, OdometryBeginsAtItsFirstPositionAndYaw) {
  Listening robot;
  const SE3 start({10, 20, 0}, kQuarterTurn.rotation()), step({2, 0, 0}, Eigen::Quaterniond::Identity());
  robot.hear_odometry(at(1000), start);
  for (int k = 1; k <= 25; ++k) robot.hear_odometry(at(1000 + k / 10.0), start * step);
  const auto rows = robot.all<StampedPose<SE3>>();
  ASSERT_EQ(rows.size(), 26U);
  EXPECT_LT(rows.front().pose.log().norm(), 1e-9);
  EXPECT_LT((rows.back().pose.translation() - Eigen::Vector3d(2, 0, 0)).norm(), 1e-9);
  ASSERT_TRUE(robot.samples().odometry_at(at(1002)));
  EXPECT_LT((robot.samples().odometry_at(at(1002))->inverse() * start * step).log().norm(), 1e-9);
  EXPECT_EQ(robot.samples().odometry_frame(), "odom");
  EXPECT_EQ(robot.samples().body_frame(), "base_link");
}

TEST(RobotSamples, SensorsAreInTheBodyFrameByStaticTransforms) {
  Listening robot;
  robot.hear(
      "/tf_static", "tf2_msgs/TFMessage",
      transforms_cdr({{{}, "base_link", "laser", kQuarterTurn}, {{}, "base_link", "imu", kQuarterTurn}}),
      at(999));
  for (int k = 0; k < 30; ++k) {
    const Stamp now = at(1000 + k / 10.0);
    robot.hear_odometry(now, SE3());
    robot.hear("/a/imu", "sensor_msgs/Imu", imu_message(now, "imu", {1, 0, 9.81}), now);
    robot.hear("/a/scan", "sensor_msgs/LaserScan", scan_message(now, "laser", {1, 2, 3}), now);
  }
  ASSERT_TRUE(robot.samples().sources());
  EXPECT_TRUE(robot.samples().sources()->scans);
  EXPECT_TRUE(robot.samples().sources()->inertial);
  EXPECT_TRUE(robot.samples().sources()->odometry);
  const auto forces = robot.all<ImuSample>();
  ASSERT_EQ(forces.size(), 30U);
  EXPECT_LT((forces[0].specific_force_mps2 - Eigen::Vector3d(0, 1, 9.81)).norm(), 1e-9);
  const auto scans = robot.all<ScanSample>();
  ASSERT_EQ(scans.size(), 30U);
  ASSERT_EQ(scans[0].scan.points.size(), 3U);
  // 3 m along x of the laser, at angle 0: 3 m along y of the body, 1 m ahead; a plane has height 0.
  EXPECT_LT((scans[0].scan.points[2] - Eigen::Vector3f(1, 3, 0)).norm(), 1e-5F);
  EXPECT_EQ(robot.samples().names().robots[0].lidar_range_m, 20);
  EXPECT_TRUE(robot.notes("transform").empty());
}

TEST(RobotSamples, AFrameThatNobodyTransformsIsSaid) {
  Listening robot;
  for (int k = 0; k < 70; ++k) {
    const Stamp now = at(1000 + k / 10.0);
    robot.hear_odometry(now, SE3());
    robot.hear("/a/scan", "sensor_msgs/LaserScan", scan_message(now, "laser", {1, 2, 3}), now);
    EXPECT_EQ(robot.samples().sources().has_value(), k >= 50)
        << k;  // it waits for the transform, not for ever
  }
  const auto notes = robot.notes("no static transform connects base_link with 'laser'");
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("/a/scan"), std::string::npos);
  EXPECT_EQ(robot.all<ScanSample>().size(), 70U);
}

TEST(RobotSamples, StampsOfAnotherClockAreSaid) {
  Listening robot;
  Stamp now = robot.settle();
  const std::size_t rows = robot.all<StampedPose<SE3>>().size();
  for (int k = 0; k < 3; ++k)
    robot.hear("/a/odom", "nav_msgs/Odometry", odometry_message(at(20 + k), SE3()), now);
  robot.hear("/a/odom", "nav_msgs/Odometry", odometry_message(at(9e8), SE3()), now);
  robot.hear("/a/odom", "nav_msgs/Odometry", odometry_message({}, SE3()), now);
  EXPECT_EQ(robot.all<StampedPose<SE3>>().size(), rows);
  const auto far = robot.notes("far from this robot's clock");
  ASSERT_EQ(far.size(), 1U);
  EXPECT_NE(far[0].find("--use-sim-time"), std::string::npos);
  ASSERT_EQ(robot.notes("stamps are zero").size(), 1U);
}

TEST(RobotSamples, TopicsOfDifferentClocksAreSaid) {
  Listening robot;
  for (int k = 0; k < 40; ++k) {
    const Stamp now = at(1000 + k / 10.0), late = at(1000 + k / 10.0 - 0.8);
    robot.hear_odometry(now, SE3());
    robot.hear("/a/imu", "sensor_msgs/Imu", imu_message(late, "base_link", {0, 0, 9.81}), now);
  }
  const auto notes = robot.notes("stamps of different clocks");
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("topics /a/imu and /a/odom"), std::string::npos) << notes[0];
}

TEST(RobotSamples, WhatIsNotPossibleIsLeftOutAndSaidOnce) {
  Listening robot;
  Stamp now = robot.settle();
  const std::size_t rows = robot.all<StampedPose<SE3>>().size();
  const auto hear_twice = [&](const std::string& topic, const std::string& type, const auto& message) {
    for (int k = 0; k < 2; ++k) {
      now.ns += 100'000'000;
      robot.hear(topic, type, message(now), now);
    }
  };
  hear_twice("/a/odom", "nav_msgs/Odometry", [](Stamp stamp) {
    return odometry_message(stamp, SE3({kNan, 0, 0}, Eigen::Quaterniond::Identity()));
  });
  hear_twice("/a/odom", "nav_msgs/Odometry", [](Stamp stamp) {
    std::string cdr = odometry_message(stamp, SE3());
    cdr[cdr.size() - 8 * (36 + 6 + 36) - 1] = 0;  // w of the orientation
    cdr[cdr.size() - 8 * (36 + 6 + 36) - 2] = 0;
    return cdr;
  });
  hear_twice("/a/odom", "nav_msgs/Odometry",
             [](Stamp stamp) { return odometry_message(stamp, SE3()).substr(0, 60); });
  const Stamp first = at(1000);
  robot.hear("/a/odom", "nav_msgs/Odometry", odometry_message(at(1003), SE3()), now);
  robot.hear("/a/odom", "nav_msgs/Odometry", odometry_message(at(1003), SE3()), now);
  EXPECT_EQ(robot.all<StampedPose<SE3>>().size(), rows + (first < now ? 1 : 0));
  for (const char* words : {"not finite, or have no orientation", "cannot be read", "same stamp"})
    EXPECT_EQ(robot.notes(words).size(), 1U) << words;
}

TEST(RobotSamples, LinksNameRobotsAnchorsAndAntennas) {
  RobotSamplesSetup setup;
  setup.names.robots.emplace_back().id = "a";
  setup.names.robots.emplace_back().id = "b";
  setup.names.anchors.push_back({"post", Eigen::Vector3d(1, 2, 3), 0.1});
  setup.antennas = {{{"front", {0.5, 0, 0}}}, {{"rear", {-0.5, 0, 0}}}};
  Listening robot({"range:post=uwb/post"}, setup);
  const Stamp now = robot.settle();
  const auto hear = [&](const RosRangeMeasurement& range) {
    robot.hear("/a/radioslam/ranges", "radioslam_msgs/RangeMeasurement", encode_cdr(range), now);
  };
  hear({{now, ""}, "front", "b", "rear", 5, 0});
  hear({{now, "base_link"}, "front", "post", "", 6, 0.2});
  hear({{now, ""}, "", "c", "", 7, 0.1});
  hear({{now, ""}, "", "a", "", 7, 0.1});
  hear({{now, ""}, "", "b", "", -7, 0.1});
  hear({{now, ""}, "", "b", "", kNan, 0.1});
  CdrWriter uwb;
  write_header(uwb, {now, "base_link"});
  uwb.u8(0).f32(0.1F).f32(0.1F).f32(100).f32(9).f32(0);
  robot.hear("/a/uwb/post", "sensor_msgs/Range", uwb.take(), now);
  const auto ranges = robot.all<RangeMeasurement>();
  ASSERT_EQ(ranges.size(), 4U);
  EXPECT_EQ(ranges[0].i.lever_arm_m.x(), 0.5);
  EXPECT_EQ(ranges[0].j.robot, RobotIndex(1));
  EXPECT_EQ(ranges[0].j.lever_arm_m.x(), -0.5);
  EXPECT_EQ(ranges[0].sigma_m, 0.1);
  EXPECT_EQ(ranges[1].j.anchor, AnchorIndex(0));
  EXPECT_EQ(ranges[1].i.lever_arm_m.x(), 0);  // by its frame
  EXPECT_EQ(robot.samples().names().robots[ranges[2].j.robot.index()].id, "c");
  EXPECT_EQ(ranges[3].range_m, 9);
  EXPECT_EQ(robot.notes("'c', which no mission names").size(), 1U);
}

TEST(RobotSamples, AnglesAreTurnedIntoTheBodyFrame) {
  Listening robot;
  robot.hear("/tf_static", "tf2_msgs/TFMessage", transforms_cdr({{{}, "base_link", "array", kQuarterTurn}}),
             at(999));
  const Stamp now = robot.settle();
  const auto hear = [&](std::vector<AoaPath> paths) {
    robot.hear("/a/radioslam/angles", "radioslam_msgs/AngleMeasurement",
               encode_cdr(RosAngleMeasurement{{now, "array"}, "b", "", std::move(paths)}), now);
  };
  hear({{0.25, std::nullopt, 0.1, 0}, {-0.5, 0.3, 0.1, -6}});
  hear({});
  hear({{kNan, std::nullopt, 0.1, 0}});
  const auto angles = robot.all<AoaMeasurement>();
  ASSERT_EQ(angles.size(), 1U);
  EXPECT_NEAR(angles[0].paths[0].azimuth_rad, 0.25 + std::numbers::pi / 2, 1e-9);
  EXPECT_FALSE(angles[0].paths[0].elevation_rad);
  EXPECT_NEAR(angles[0].paths[1].azimuth_rad, -0.5 + std::numbers::pi / 2, 1e-9);
  EXPECT_NEAR(*angles[0].paths[1].elevation_rad, 0.3, 1e-9);
}

TEST(RobotSamples, WifiScansHaveTheStrongestReadingOfAnAccessPoint) {
  Listening robot;
  const Stamp now = robot.settle();
  robot.hear("/a/radioslam/wifi", "radioslam_msgs/WifiScan",
             encode_cdr(RosWifiScan{{now, ""},
                                    {{"00:16:EA:12:34:56", 2412, -60},
                                     {"0016.ea12.3456", 2412, -50},
                                     {"00:16:ea:12:34:57", 2412, -70},
                                     {"nobody", 2412, -70},
                                     {"00:16:ea:12:34:58", 2412, 70}}}),
             now);
  const auto scans = robot.all<WifiScan>();
  ASSERT_EQ(scans.size(), 1U);
  ASSERT_EQ(scans[0].readings.size(), 2U);
  EXPECT_EQ(scans[0].readings[0].rssi_dbm, -50);
  EXPECT_EQ(robot.samples().names().access_points,
            (std::vector<std::string>{"00:16:ea:12:34:56", "00:16:ea:12:34:57"}));
  EXPECT_EQ(robot.notes("a level in dBm").size(), 1U);
}

TEST(RobotSamples, FixesNeedAnOrigin) {
  const auto fix = [](Stamp stamp) {
    CdrWriter out;
    write_header(out, {stamp, "base_link"});
    out.u8(0).u16(1).f64(48.0001).f64(11).f64(500);
    for (const double variance : {4.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 9.0}) out.f64(variance);
    return out.u8(2).take();
  };
  for (const bool has_origin : {false, true}) {
    RobotSamplesSetup setup;
    if (has_origin)
      setup.origin = GeodeticPlace{48 * std::numbers::pi / 180, 11 * std::numbers::pi / 180, 500};
    Listening robot({}, setup);
    for (int k = 0; k < 30; ++k) {
      robot.hear_odometry(at(1000 + k / 10.0), SE3());
      robot.hear("/a/fix", "sensor_msgs/NavSatFix", fix(at(1000 + k / 10.0)), at(1000 + k / 10.0));
    }
    const auto fixes = robot.all<PositionFix>();
    ASSERT_EQ(fixes.size(), has_origin ? 30U : 0U);
    EXPECT_EQ(robot.notes("--origin").size(), has_origin ? 0U : 1U);
    if (!has_origin) continue;
    EXPECT_NEAR(fixes[0].position_m.y(), 11.1, 0.1);  // a ten-thousandth of a degree to the north
    EXPECT_EQ(fixes[0].sigma_m, 3);
  }
}

TEST(RobotSamples, OfTwoTopicsOfAKindOneIsUsedAndTheOtherSaid) {
  Listening robot;
  for (int k = 0; k < 60; ++k) {
    const Stamp now = at(1000 + k / 10.0);
    robot.hear("/a/imu", "sensor_msgs/Imu", imu_message(now, "base_link", {0, 0, 9.81}), now);
    robot.hear("/a/imu/data", "sensor_msgs/Imu", imu_message(now, "base_link", {0, 0, 9.7}), now);
    robot.hear_odometry(now, SE3());
  }
  for (const ImuSample& sample : robot.all<ImuSample>()) EXPECT_EQ(sample.specific_force_mps2.z(), 9.81);
  EXPECT_EQ(robot.notes("--topic imu=/a/imu/data takes this one").size(), 1U);
}

TEST(RobotTopics, ThatCannotBeAreRefused) {
  for (const char* wrong :
       {"odometry", "lidar=/a", "scans=/a b", "scans=/1a", "range=uwb", "odometry:b=odom"})
    EXPECT_THROW(robot_topics("/a", {wrong}), std::exception) << wrong;
  EXPECT_THROW(robot_topics("/a", {"imu=x", "imu=y"}), std::exception);
}

TEST(RobotTopics, AreRelativeToTheNamespaceOrAbsolute) {
  const RobotTopics topics = robot_topics("/a", {"odometry=wheel/odom", "scans=/lidar", "imu=none", "tf=tf"});
  EXPECT_EQ(topics.transforms, "/a/tf");
  EXPECT_EQ(topics.static_transforms, "/a/tf_static");
  ASSERT_GE(topics.measured.size(), 2U);
  EXPECT_EQ(topics.measured[0].name, "/a/wheel/odom");
  EXPECT_EQ(topics.measured[1].name, "/lidar");
  for (const RobotTopic& topic : topics.measured) EXPECT_NE(topic.kind, RobotTopicKind::kImu);
}

}  // namespace
}  // namespace radioslam
