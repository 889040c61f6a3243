#include "radioslam/io/ros/ros_import.hpp"

#include <cmath>
#include <functional>
#include <map>

#include "io/recorded_data.hpp"
#include "io/refusal.hpp"
#include "io/temporary_folder.hpp"
#include "ros_bytes.hpp"

namespace radioslam {
namespace {

const double kHalf = std::sqrt(0.5);

std::string ros2(const std::function<void(RosBytes&)>& fill) {
  RosBytes bytes(MessageEncoding::kCdr);
  fill(bytes);
  return bytes.bytes();
}

WrittenMessage odometry(unsigned seconds, double x, const std::string& topic = "/odom") {
  return {topic, "nav_msgs/Odometry", 7, ros2([&](RosBytes& bytes) {
            bytes.header(seconds, 0, "odom").text("base").f64s({x, 1, 0.5, 0, 0, kHalf, kHalf});
          })};
}

WrittenMessage pose(unsigned seconds, double x) {
  return {"/truth", "geometry_msgs/PoseStamped", 7, ros2([&](RosBytes& bytes) {
            bytes.header(seconds, 0, "map").f64s({x, 0, 0, 0, 0, 0, 1});
          })};
}

/// The laser is 1 m in front of the base and faces left.
WrittenMessage static_transform(const std::string& child) {
  return {"/tf_static", "tf2_msgs/TFMessage", 7, ros2([&](RosBytes& bytes) {
            bytes.u32(1).header(0, 0, "base").text(child).f64s({1, 0, 0.2, 0, 0, kHalf, kHalf});
          })};
}

/// One reading of 2 m straight ahead.
WrittenMessage laser(unsigned seconds, const std::string& topic = "/scan",
                     const std::string& frame = "laser") {
  return {topic, "sensor_msgs/LaserScan", 9, ros2([&](RosBytes& bytes) {
            bytes.header(seconds, 0, frame);
            for (const float value : {0.0F, 1.0F, 1.0F, 0.0F, 0.1F, 0.5F, 12.0F}) bytes.f32(value);
            bytes.u32(1).f32(2).u32(0);
          })};
}

WrittenMessage imu(unsigned seconds, const std::string& frame) {
  return {"/imu", "sensor_msgs/Imu", 9, ros2([&](RosBytes& bytes) {
            bytes.header(seconds, 0, frame).f64s(std::vector<double>(13)).f64s({0.1, 0, 0});
            bytes.f64s(std::vector<double>(9)).f64s({9, 0, 4}).f64s(std::vector<double>(9));
          })};
}

/// An import and the scans that it passes on.
struct Imported {
  ImportedMission mission;
  std::map<Stamp, LidarScan> scans;

  const Robot& robot() const { return mission.mission.robots.at(0); }
  std::string notes() const {
    std::string all;
    for (const std::string& warning : mission.warnings) all += warning + '\n';
    return all;
  }
};

Imported import(const std::vector<WrittenMessage>& messages, const RosTopicRequest& wishes = {}) {
  const TemporaryFolder folder;
  const auto file = folder.write("x.mcap", mcap_of(mcap_records(messages)));
  Imported result;
  const auto sink = [&](Stamp stamp, const LidarScan& scan) { result.scans[stamp] = scan; };
  std::vector<RosImport> team{import_ros_recording(file, "a", wishes, sink)};
  place_fixes(team);
  result.mission = team.front().imported;
  return result;
}

TEST(RosImport, TransformsMeasurementsToTheBodyFrame) {
  const auto imported =
      import({laser(5), odometry(4, 3), odometry(5, 3.5), imu(4, "laser"), static_transform("laser")});
  const Robot& robot = imported.robot();
  EXPECT_EQ(imported.mission.mission.dimension, 2);
  EXPECT_EQ(robot.lidar_range_m, 12);
  ASSERT_EQ(robot.odometry.size(), 2U);
  EXPECT_LT(robot.odometry[0].pose.log().norm(), 1e-12);
  EXPECT_LT((robot.odometry[1].pose.translation() - Eigen::Vector3d(0, -0.5, 0)).norm(), 1e-12)
      << "the robot faced +y and moved along +x";
  ASSERT_EQ(imported.scans.size(), 1U);
  EXPECT_LT((imported.scans.at({5'000'000'000}).points.at(0) - Eigen::Vector3f(1, 2, 0)).norm(), 1e-6);
  ASSERT_EQ(robot.inertial.size(), 1U);
  EXPECT_LT((robot.inertial[0].specific_force_mps2 - Eigen::Vector3d(0, 9, 4)).norm(), 1e-12);
  EXPECT_LT((robot.inertial[0].angular_rate_radps - Eigen::Vector3d(0, 0.1, 0)).norm(), 1e-12);
  EXPECT_EQ(imported.notes(), "/imu: the IMU's position in the body frame is not taken into account\n");
}

TEST(RosImport, AssumesTheBodyFrameForUnconnectedSensors) {
  const auto imported = import({laser(5), odometry(4, 3)});
  EXPECT_LT((imported.scans.begin()->second.points.at(0) - Eigen::Vector3f(2, 0, 0)).norm(), 1e-6);
  EXPECT_EQ(imported.notes(),
            "/scan: no static transform connects base with laser; 'laser' is assumed to be the body frame\n");
  EXPECT_NE(import({laser(5)}).notes().find("the body frame is unknown"), std::string::npos);
}

/// A laser mounted upside down, 1 m ahead, and odometry, both on /tf as in ROS 1.
WrittenMessage repeated_transforms(unsigned seconds, double x) {
  return {"/tf", "tf2_msgs/TFMessage", 7, ros2([&](RosBytes& bytes) {
            bytes.u32(2).header(seconds, 0, "base").text("laser").f64s({1, 0, 0, 1, 0, 0, 0});
            bytes.header(seconds, 0, "odom").text("base").f64s({x, 0, 0, 0, 0, 0, 1});
          })};
}

WrittenMessage side_laser(unsigned seconds) {
  return {"/scan", "sensor_msgs/LaserScan", 9, ros2([&](RosBytes& bytes) {
            bytes.header(seconds, 0, "laser");
            for (const float value : {1.5707964F, 1.0F, 1.0F, 0.0F, 0.1F, 0.5F, 12.0F}) bytes.f32(value);
            bytes.u32(1).f32(2).u32(0);
          })};
}

TEST(RosImport, TreatsConstantTransformsOfAnyTopicAsStatic) {
  const auto first_point = [](const std::vector<WrittenMessage>& messages) {
    return import(messages).scans.begin()->second.points.at(0);
  };
  const Eigen::Vector3f right(1, -2, 0), unchanged(0, 2, 0);
  const auto repeated = {repeated_transforms(1, 0), repeated_transforms(2, 0.5), side_laser(5),
                         odometry(1, 0)};
  EXPECT_LT((first_point(repeated) - right).norm(), 1e-6) << "its left is the body's right";
  EXPECT_EQ(import(repeated).notes(), "");
  EXPECT_LT((first_point({repeated_transforms(1, 0), side_laser(5), odometry(1, 0)}) - unchanged).norm(),
            1e-6)
      << "a single message is not constant";
  WrittenMessage moved = static_transform("laser");
  moved.topic = "/tf";
  EXPECT_LT(
      (first_point({repeated_transforms(1, 0), moved, side_laser(5), odometry(1, 0)}) - unchanged).norm(),
      1e-6)
      << "it moves";
  EXPECT_LT((first_point({static_transform("laser"), repeated_transforms(1, 0), repeated_transforms(2, 1),
                          side_laser(5), odometry(1, 0)}) -
             Eigen::Vector3f(-1, 0, 0))
                .norm(),
            1e-6)
      << "tf_static counts more";
}

TEST(RosImport, TakesTheUsualBodyWithoutANote) {
  EXPECT_EQ(import({laser(5, "/scan", "base_link")}).notes(), "");
  EXPECT_NE(import({laser(5, "/scan", "lidar")}).notes().find("the body frame is unknown"),
            std::string::npos);
}

/// Clouds every 0.1 s, each of two points whose times differ by 50,000, beginning at `first`.
WrittenMessage timed_cloud(unsigned k, std::uint64_t first) {
  return {"/points", "sensor_msgs/PointCloud2", 9, ros2([&](RosBytes& bytes) {
            bytes.header(5, k * 100'000'000U, "base_link").u32(1).u32(2).u32(4);
            for (const char* axis : {"x", "y", "z"}) bytes.text(axis).u32(0).u8(7).u32(1);
            bytes.text("t").u32(4).u8(6).u32(1).u8(0).u32(8).u32(16);
            RosBytes rows(MessageEncoding::kRos1);
            rows.f32(1).u32(first).f32(2).u32(first + 50'000);
            bytes.u32(16).raw(rows.bytes()).u8(1);
          })};
}

std::vector<WrittenMessage> timed_clouds(unsigned number, std::uint64_t first) {
  std::vector<WrittenMessage> clouds;
  for (unsigned k = 0; k < number; ++k) clouds.push_back(timed_cloud(number - 1 - k, first));
  return clouds;
}

TEST(RosImport, FindsTheUnitOfPointsTimes) {
  for (const unsigned number : {2U, 9U, 10U, 11U, 13U}) {
    const auto imported = import(timed_clouds(number, 0));
    ASSERT_EQ(imported.scans.size(), number);
    for (const auto& scan : imported.scans) EXPECT_EQ(scan.second.times_s, (std::vector<float>{0, 0.05F}));
    EXPECT_EQ(imported.notes(),
              "/points: the points' times are assumed to be in microseconds: in nanoseconds the duration of "
              "a sweep would not match the interval between scans\n");
  }
  const auto alone = import(timed_clouds(1, 0));
  EXPECT_EQ(alone.scans.begin()->second.times_s, (std::vector<float>{0, 5e-5F}))
      << "no interval to determine the unit from";
  EXPECT_EQ(alone.notes(), "");
}

TEST(RosImport, NotesOncePerTopicThatClocksDiffer) {
  const auto imported = import(timed_clouds(12, 3'000'000'000));
  EXPECT_EQ(imported.scans.begin()->second.times_s, (std::vector<float>{0, 0.05F}));
  EXPECT_NE(imported.notes().find("\n/points: the points' times are from another clock than the scans' "
                                  "stamps; the first point is assigned the stamp, in 12 scans\n"),
            std::string::npos)
      << imported.notes();
}

TEST(RosImport, LeavesOutImuSamplesMarkedAsIncomplete) {
  WrittenMessage none = imu(4, "base");
  none.bytes = ros2([&](RosBytes& bytes) {
    bytes.header(4, 0, "base").f64s(std::vector<double>(16)).f64(-1).f64s(std::vector<double>(20));
  });
  const auto imported = import({odometry(4, 3), none, imu(5, "base")});
  EXPECT_EQ(imported.robot().inertial.size(), 1U);
  EXPECT_EQ(imported.notes(),
            "/imu: 1 IMU samples are marked as incomplete (no rates or no forces) and left out\n");
}

/// A chain of transforms: map to odometry frame to body (both moving), and a laser on the body.
WrittenMessage moving_transform(unsigned seconds, const char* parent, const char* child, double x) {
  return {"/tf", "tf2_msgs/TFMessage", 7, ros2([&](RosBytes& bytes) {
            bytes.u32(1).header(seconds, 0, parent).text(child).f64s({x, 0, 0, 0, 0, kHalf, kHalf});
          })};
}

TEST(RosImport, ComposesMovingTransforms) {
  const std::vector<WrittenMessage> messages{
      moving_transform(10, "map", "odom", 0),  moving_transform(20, "map", "odom", 10),
      moving_transform(9, "odom", "base", 0),  moving_transform(10, "odom", "base", 1),
      moving_transform(15, "odom", "base", 2), moving_transform(20, "odom", "base", 3),
      moving_transform(21, "odom", "base", 4), static_transform("laser")};
  const auto chain = import(messages, {"/tf:odom.base", "", "", "/tf:map.base"});
  const auto& truth = chain.mission.truth.robots.at(0).poses;
  ASSERT_EQ(truth.size(), 3U) << "when both are known";
  EXPECT_EQ(truth[1].stamp, Stamp{15'000'000'000});
  EXPECT_LT((truth[1].pose.translation() - Eigen::Vector3d(5, 2, 0)).norm(), 1e-12) << "half way";
  EXPECT_NEAR(std::abs(truth[1].pose.yaw()), std::acos(-1.0), 1e-12);
  EXPECT_EQ(
      chain.notes(),
      "/tf: 2 poses are left out because another transform between the frames is unknown at their time\n");
  const auto back = import(messages, {"/tf:odom.base", "", "", "/tf:laser.map"});
  const auto laser = import(messages, {"/tf:odom.base", "", "", "/tf:map.laser"});
  EXPECT_LT((back.mission.truth.robots.at(0).poses[1].pose * laser.mission.truth.robots.at(0).poses[1].pose)
                .log()
                .norm(),
            1e-12)
      << "in the other direction";
  expect_refusal(
      [&] {
        import(messages, {"/tf:map.wheel", "", "", ""});
      },
      0, "no transforms connect map with wheel");
  EXPECT_NE(import(messages, {"/tf:odom.base", "", "", "/tf:map.wheel"}).notes().find("has no valid pose"),
            std::string::npos);
}

WrittenMessage position_fix(unsigned seconds, double latitude_deg, double height_m, unsigned status = 0) {
  return {"/fix", "sensor_msgs/NavSatFix", 9, ros2([&](RosBytes& bytes) {
            bytes.header(seconds, 0, "laser").u8(status).u16(1).f64s({latitude_deg, 11, height_m});
            bytes.f64s(std::vector<double>(9)).u8(0);
          })};
}

TEST(RosImport, BringsFixesIntoOneLocalFrame) {
  const auto imported =
      import({odometry(4, 3), static_transform("laser"), position_fix(6, 48.00001, std::nan("")),
              position_fix(5, 48, 500), position_fix(7, 48, 503), position_fix(8, 48, 1, 255)});
  const Robot& robot = imported.robot();
  ASSERT_EQ(robot.fixes.size(), 3U);
  EXPECT_EQ(robot.fixes[0].position_m, Eigen::Vector3d::Zero());
  EXPECT_LT((robot.fixes[1].position_m - Eigen::Vector3d(0, 1.112, 0)).norm(), 1e-3)
      << "10 millionths of a degree";
  EXPECT_LT((robot.fixes[2].position_m - Eigen::Vector3d(0, 0, 3)).norm(), 1e-6);
  EXPECT_EQ(robot.fixes[2].sigma_m, 10);
  EXPECT_LT((robot.fix_lever_m - Eigen::Vector3d(1, 0, 0.2)).norm(), 1e-12) << "where the antenna sits";
  EXPECT_EQ(imported.notes(),
            "/fix: 3 fixes state no sigma; 10 m is assumed\n/fix: 1 messages without a fix are left out\n");
}

WrittenMessage fix_with_covariance(unsigned seconds, double latitude_deg, double longitude_deg,
                                   const std::vector<double>& variances) {
  return {"/fix", "sensor_msgs/NavSatFix", 9, ros2([&](RosBytes& bytes) {
            bytes.header(seconds, 0, "base").u8(0).u16(1).f64s({latitude_deg, longitude_deg, 0});
            for (std::size_t axis = 0; axis < 3; ++axis) {
              bytes.f64(variances[axis]);
              if (axis < 2) bytes.f64s({0, 0, 0});
            }
            bytes.u8(2);
          })};
}

TEST(RosImport, ZerosOfAReceiverWithoutAFixAreNone) {
  const std::vector<double> none(3, 0), four(3, 4);
  const auto imported = import({odometry(4, 3), fix_with_covariance(4, 0, 0, none),
                                fix_with_covariance(5, 48, 11, four), fix_with_covariance(6, 0, 0, none)});
  ASSERT_EQ(imported.robot().fixes.size(), 1U);
  EXPECT_EQ(imported.robot().fixes[0].position_m, Eigen::Vector3d::Zero());
  EXPECT_EQ(imported.robot().fixes[0].sigma_m, 2);
  EXPECT_EQ(imported.notes(), "/fix: 2 messages without a fix are left out\n");
  const auto invalid = import({odometry(4, 3), fix_with_covariance(5, 48, 11, {4, std::nan(""), 4})});
  EXPECT_EQ(invalid.robot().fixes.at(0).sigma_m, 10) << "a covariance that is not finite states nothing";
}

TEST(RosImport, TheOriginIsAFixThatOthersAgreeWith) {
  const std::vector<double> four(3, 4);
  const auto imported = import({odometry(4, 3), fix_with_covariance(4, 0, 0, four),
                                fix_with_covariance(5, 48, 11, four), fix_with_covariance(6, 48, 11, four)});
  ASSERT_EQ(imported.robot().fixes.size(), 2U);
  EXPECT_EQ(imported.robot().fixes[0].position_m, Eigen::Vector3d::Zero());
  EXPECT_EQ(imported.notes(),
            "1 position fixes of a are more than 1000 km from the team's and are left out\n");
}

TEST(RosImport, ABadFixOfOneRobotIsNotTheTeamsOrigin) {
  const std::vector<double> four(3, 4);
  const TemporaryFolder folder;
  const auto a =
      folder.write("a.mcap", mcap_of(mcap_records({odometry(4, 3), fix_with_covariance(5, 1, 1, four)})));
  const auto b =
      folder.write("b.mcap", mcap_of(mcap_records({odometry(4, 3), fix_with_covariance(5, 48, 11, four),
                                                   fix_with_covariance(6, 48.00001, 11, four)})));
  const auto sink = [](Stamp, const LidarScan&) {};
  std::vector<RosImport> team{import_ros_recording(a, "a", {}, sink), import_ros_recording(b, "b", {}, sink)};
  place_fixes(team);
  EXPECT_TRUE(team[0].imported.mission.robots[0].fixes.empty());
  const auto& fixes = team[1].imported.mission.robots[0].fixes;
  ASSERT_EQ(fixes.size(), 2U);
  EXPECT_LT((fixes[1].position_m - Eigen::Vector3d(0, 1.112, 0)).norm(), 1e-3);
}

TEST(RosImport, PutsMessagesInOrderOnce) {
  const auto imported =
      import({odometry(9, 1), odometry(4, 3), odometry(9, 2), laser(2), laser(1), laser(2)});
  ASSERT_EQ(imported.robot().odometry.size(), 2U);
  EXPECT_EQ(imported.robot().odometry[1].stamp, Stamp{9'000'000'000});
  EXPECT_NEAR(imported.robot().odometry[1].pose.translation().norm(), 2, 1e-12) << "the first of two counts";
  EXPECT_EQ(imported.scans.size(), 2U);
  EXPECT_NE(imported.notes().find("/odom: 1 messages with the same stamp as another one"), std::string::npos);
  EXPECT_NE(imported.notes().find("/scan: 1 messages with the same stamp as another one"), std::string::npos);
}

/// The message, recorded at another time.
WrittenMessage recorded_at(std::int64_t time_ns, WrittenMessage message) {
  message.time_ns = time_ns;
  return message;
}

TEST(RosImport, AMessageWithoutAStampDisplacesNoSoundOne) {
  // Recorded exactly when the next one was measured.
  const auto imported = import({odometry(4, 3), recorded_at(5'000'000'000, odometry(0, 99)), odometry(5, 4),
                                laser(4), recorded_at(5'000'000'000, laser(0)), laser(5)});
  ASSERT_EQ(imported.robot().odometry.size(), 2U);
  EXPECT_NEAR(imported.robot().odometry[1].pose.translation().norm(), 1, 1e-12);
  EXPECT_EQ(imported.scans.size(), 2U);
  EXPECT_NE(imported.notes().find(
                "/odom: 1 messages have no stamp, unlike others of their topic, and are left out\n/scan: 1 "),
            std::string::npos)
      << imported.notes();
}

TEST(RosImport, TopicsWithoutStampsHaveTheTimeOfTheirRecording) {
  const auto imported =
      import({recorded_at(4'000'000'000, odometry(0, 3)), recorded_at(5'000'000'000, odometry(0, 4))});
  EXPECT_EQ(imported.robot().odometry[1].stamp, Stamp{5'000'000'000});
  EXPECT_EQ(imported.notes(), "/odom: 2 messages have no stamp; the recording time is used\n");
  // Replayed 100 s after it was measured, as the other topic says.
  const auto replayed =
      import({recorded_at(104'000'000'000, odometry(0, 3)), recorded_at(104'000'000'000, laser(4))});
  EXPECT_EQ(replayed.robot().odometry[0].stamp, Stamp{4'000'000'000});
}

TEST(RosImport, SkipsMessagesThatCannotBeRead) {
  WrittenMessage short_odometry = odometry(5, 9), short_scan = laser(5), short_imu = imu(5, "base");
  for (WrittenMessage* message : {&short_odometry, &short_scan, &short_imu}) message->bytes.resize(30);
  const auto imported = import({odometry(4, 3), short_odometry, odometry(6, 4), laser(4), short_scan,
                                laser(6), imu(4, "base"), short_imu});
  EXPECT_EQ(imported.robot().odometry.size(), 2U);
  EXPECT_EQ(imported.scans.size(), 2U);
  EXPECT_EQ(imported.robot().inertial.size(), 1U);
  for (const char* topic : {"/odom", "/scan", "/imu"})
    EXPECT_NE(imported.notes().find(std::string(topic) + ": 1 message is left out; the first: "),
              std::string::npos)
        << imported.notes();
  expect_refusal([&] { import({short_odometry, laser(4)}); }, 0, "a message of /odom");
  expect_refusal([&] { import({short_scan, odometry(4, 3)}); }, 0, "a message of /scan");
}

TEST(RosImport, TakesTheTruthOnlyWhenAsked) {
  const std::vector<WrittenMessage> messages{odometry(4, 3), pose(4, 10), pose(5, 11)};
  const auto unasked = import(messages);
  EXPECT_TRUE(unasked.mission.truth.robots.empty());
  EXPECT_NE(unasked.notes().find("--truth TOPIC selects one of /truth (geometry_msgs/PoseStamped, 2)"),
            std::string::npos);
  const auto asked = import(messages, {"", "", "", "/truth"});
  ASSERT_EQ(asked.mission.truth.robots.size(), 1U);
  EXPECT_EQ(asked.mission.truth.robots[0].poses[1].pose.translation().x(), 11) << "in its own frame";
  EXPECT_EQ(asked.notes(), "");
}

TEST(RosImport, TakesPosesOutOfTransforms) {
  const WrittenMessage tf{"/tf", "tf2_msgs/TFMessage", 7, ros2([](RosBytes& bytes) {
                            bytes.u32(2).header(3, 0, "odom").text("base").f64s({5, 0, 0, 0, 0, 0, 1});
                            bytes.header(3, 0, "map").text("odom").f64s({9, 9, 9, 0, 0, 0, 1});
                          })};
  const auto imported = import({tf, static_transform("laser")}, {"/tf:odom.laser", "", "", "/tf:odom.base"});
  EXPECT_EQ(imported.mission.truth.robots[0].poses[0].pose.translation(), Eigen::Vector3d(5, 0, 0));
  ASSERT_EQ(imported.robot().odometry.size(), 1U);
  const auto base = import({tf, static_transform("laser")}, {"/tf:odom.base", "", "", "/tf:odom.laser"});
  EXPECT_LT((base.mission.truth.robots[0].poses[0].pose.translation() - Eigen::Vector3d(6, 0, 0.2)).norm(),
            1e-12);
}

TEST(RosImport, RefusesWithTheTopicsThereAre) {
  const std::vector<WrittenMessage> two{odometry(4, 3), odometry(4, 3, "/wheels"), laser(4),
                                        laser(4, "/rear")};
  const auto refuse = [](const std::vector<WrittenMessage>& messages, const RosTopicRequest& wishes,
                         const char* words) { expect_refusal([&] { import(messages, wishes); }, 0, words); };
  refuse(two, {},
         "has 2 topics with odometry; --odometry selects one of them, or none: /odom (nav_msgs/Odometry, 1), "
         "/wheels "
         "(nav_msgs/Odometry, 1)");
  refuse(two, {"/odom", "", "", ""}, "--scans selects one");
  refuse(two, {"/x", "", "", ""}, "--odometry: unknown topic /x; the recording has /odom");
  refuse(two, {"/scan", "", "", ""},
         "--odometry: /scan has type sensor_msgs/LaserScan, which is not one of odometry");
  refuse(two, {"/odom", "none", "", "/tf:a.b"}, "--truth: unknown topic of transforms /tf");
  refuse({pose(1, 2)}, {}, "neither odometry nor laser scans");
  refuse({static_transform("laser")}, {"/tf_static", "", "", ""}, "/tf_static:FRAME.CHILD selects one");
  refuse({static_transform("laser")}, {"/tf_static:a", "", "", ""}, "two frames separated by a point");
  refuse({static_transform("laser")}, {"/tf_static:a.b", "", "", ""}, "has no valid pose");
  EXPECT_EQ(import(two, {"/odom", "/rear", "", ""}).scans.size(), 1U);
  EXPECT_TRUE(import(two, {"none", "/rear", "", ""}).robot().odometry.empty());
  EXPECT_TRUE(import(two, {"", "none", "", "/wheels"}).scans.empty()) << "the truth is not the odometry too";
}

TEST(RosImport, ReadsFoldersAndRefusesWhatIsNoRecording) {
  const TemporaryFolder folder;
  expect_refusal([&] { index_recording(folder.path()); }, 0, "contains no recording");
  expect_refusal([&] { index_recording(folder.path() / "none"); }, 0, "no such file");
  folder.write("b.mcap", mcap_of(mcap_records({laser(5)})));
  folder.write("a.bag", bag_of(""));
  folder.write("metadata.yaml", "rosbag2_bagfile_information:");
  EXPECT_EQ(list_of_topics(index_recording(folder.path()).topics), "/scan (sensor_msgs/LaserScan, 1)");
}

TEST(FrameTree, FollowsChainsInBothDirections) {
  FrameTree tree;
  const SE3 T_base_mast({0, 0, 1}, Eigen::Quaterniond::Identity());
  const SE3 T_mast_laser({1, 0, 0}, Eigen::Quaterniond(kHalf, 0, 0, kHalf));
  const SE3 T_base_imu({0, 2, 0}, Eigen::Quaterniond::Identity());
  tree.add("base", "mast", T_base_mast);
  tree.add("mast", "laser", T_mast_laser);
  tree.add("base", "imu", T_base_imu);
  tree.add("x", "y", {});
  EXPECT_TRUE(tree.knows("base") && tree.knows("imu") && !tree.knows("z"));
  EXPECT_LT((tree.find("base", "laser")->inverse() * (T_base_mast * T_mast_laser)).log().norm(), 1e-12);
  EXPECT_LT((*tree.find("imu", "laser") * *tree.find("laser", "imu")).log().norm(), 1e-12);
  EXPECT_LT((tree.find("imu", "laser")->translation() - Eigen::Vector3d(1, -2, 1)).norm(), 1e-12);
  EXPECT_LT(tree.find("z", "z")->log().norm(), 1e-12) << "a frame lies on itself";
  EXPECT_FALSE(tree.find("base", "y"));
  tree.add("laser", "base", T_base_imu);  // a loop, which is invalid
  EXPECT_TRUE(tree.find("base", "imu"));
}

/// The same recording in the formats of ROS 1 and ROS 2.
TEST(RosImport, RecordedBagAndDatabaseAreOne) {
  RADIOSLAM_RECORDED(folder, "ros_logs");
  const auto read = [&](const char* name) {
    return import_ros_recording(folder / name, "a", {"/tf:odom.base_link", "", "", ""},
                                [](Stamp, const LidarScan&) {})
        .imported.mission.robots.at(0)
        .odometry;
  };
  const auto bag = read("tf_example.bag");
  const auto database = read("tf_example");
  ASSERT_EQ(bag.size(), 517U);
  ASSERT_EQ(database.size(), 517U);
  for (std::size_t k = 0; k < bag.size(); ++k) {
    EXPECT_EQ(bag[k].stamp, database[k].stamp);
    EXPECT_EQ(bag[k].pose.translation(), database[k].pose.translation());
  }
}

/// The expected counts are from the sqlite3 program and the files' own statistics.
TEST(RosImport, RecordedTopicsAreCounted) {
  RADIOSLAM_RECORDED(mcap, "ros_logs/nav2_turtlebot.mcap");
  EXPECT_EQ(list_of_topics(index_recording(mcap).topics),
            "/amcl_pose (geometry_msgs/PoseWithCovarianceStamped, 135), /odom (nav_msgs/Odometry, 2639), /tf "
            "(tf2_msgs/TFMessage, 5422), /tf_static (tf2_msgs/TFMessage, 1)");
  const RosTopicIndex team = index_recording(recorded_data("tiers/shortbag.db3"));
  EXPECT_EQ(team.topics.size(), 45U);
  EXPECT_EQ(team.find("/vrpn_client_node/turtlebot3_cap/pose")->messages, 1032U);
}

}  // namespace
}  // namespace radioslam
