// Each message in the encoding of ROS 1, and of ROS 2 in both byte orders.
#include "radioslam/io/ros/ros_types.hpp"

#include <cmath>
#include <limits>

#include "io/refusal.hpp"
#include "ros_bytes.hpp"

namespace radioslam {
namespace {

struct Layout {
  const char* name;
  MessageEncoding encoding;
  ByteOrder order;
};

class RosTypes : public testing::TestWithParam<Layout> {
 protected:
  static RosBytes message() { return RosBytes(GetParam().encoding, GetParam().order); }
  static RosMessage as(const RosChannel& channel, const RosBytes& bytes) {
    return {channel, {}, bytes.bytes(), "x.mcap"};
  }
  static RosChannel channel(const std::string& type) { return {"/topic", type, GetParam().encoding}; }
};

INSTANTIATE_TEST_SUITE_P(Layouts, RosTypes,
                         testing::Values(Layout{"Ros1", MessageEncoding::kRos1, ByteOrder::kLittle},
                                         Layout{"CdrLittle", MessageEncoding::kCdr, ByteOrder::kLittle},
                                         Layout{"CdrBig", MessageEncoding::kCdr, ByteOrder::kBig}),
                         [](const auto& layout) { return std::string(layout.param.name); });

TEST_P(RosTypes, Odometry) {
  // Frame names of every length, so that all alignments of the following values occur.
  for (const char* frame : {"", "o", "od", "odo", "odom"}) {
    RosBytes bytes = message();
    bytes.header(100, 250, frame).text("/base").f64s({1, 2, 3, 0, 0, 0.6, 0.8}).f64s(std::vector<double>(36));
    const RosChannel odometry = channel("nav_msgs/Odometry");
    const RosPose pose = read_ros_pose(as(odometry, bytes));
    EXPECT_EQ(pose.header.stamp, Stamp{100'000'000'250});
    EXPECT_EQ(pose.header.frame, frame);
    EXPECT_EQ(pose.child, "base") << "without ROS 1's slash";
    ASSERT_TRUE(pose.pose);
    EXPECT_EQ(pose.pose->translation(), Eigen::Vector3d(1, 2, 3));
    EXPECT_NEAR(pose.pose->yaw(), 2 * std::atan2(0.6, 0.8), 1e-12);
  }
}

TEST_P(RosTypes, PosesAndTransforms) {
  RosBytes stamped = message();
  stamped.header(1, 0, "map").f64s({1, 2, 3, 0, 0, 0, 1});
  for (const char* type : {"geometry_msgs/PoseStamped", "geometry_msgs/PoseWithCovarianceStamped"}) {
    const RosChannel poses = channel(type);
    EXPECT_EQ(read_ros_pose(as(poses, stamped)).pose->translation(), Eigen::Vector3d(1, 2, 3));
  }
  RosBytes list = message();
  list.u32(2).header(1, 0, "map").text("a").f64s({1, 2, 3, 0, 0, 0, 1});
  list.header(2, 0, "map").text("bcd").f64s({4, 5, 6, 0, 0, 0, 0});
  const RosChannel tf = channel("tf2_msgs/TFMessage");
  const auto transforms = read_ros_transforms(as(tf, list));
  ASSERT_EQ(transforms.size(), 2U);
  EXPECT_EQ(transforms[0].child, "a");
  EXPECT_EQ(transforms[1].child, "bcd");
  EXPECT_EQ(transforms[1].header.stamp, Stamp{2'000'000'000});
  EXPECT_FALSE(transforms[1].pose) << "a quaternion of zeros";
}

/// Points of x, t (ns), y, z, in two rows of two with padding after each row.
RosBytes cloud(RosBytes bytes, ByteOrder points, const std::string& frame) {
  bytes.header(1, 0, frame).u32(2).u32(2).u32(4);
  bytes.text("x").u32(0).u8(7).u32(1).text("t").u32(4).u8(6).u32(1);
  bytes.text("y").u32(8).u8(7).u32(1).text("z").u32(12).u8(8).u32(1);
  std::string data;
  for (int k = 0; k < 4; ++k) {
    const auto x = static_cast<float>(k);
    RosBytes record(MessageEncoding::kRos1, points);
    record.f32(x).u32(static_cast<std::uint64_t>(k) * 500'000'000U).f32(-x).f64(0.5);
    data += record.bytes();
    if (k % 2 == 1) data += "gap";
  }
  bytes.u8(points == ByteOrder::kBig ? 1 : 0).u32(20).u32(43).u32(data.size()).raw(data).u8(1);
  return bytes;
}

TEST_P(RosTypes, PointClouds) {
  const RosChannel points = channel("sensor_msgs/PointCloud2");
  for (const ByteOrder order : {ByteOrder::kLittle, ByteOrder::kBig})
    for (const char* frame : {"os", "velodyne"}) {
      const RosScan scan = read_ros_scan(as(points, cloud(message(), order, frame)));
      EXPECT_EQ(scan.header.frame, frame);
      ASSERT_EQ(scan.scan.points.size(), 4U);
      EXPECT_EQ(scan.scan.points[3], Eigen::Vector3f(3, -3, 0.5F));
      EXPECT_EQ(scan.scan.times_s, (std::vector<float>{0, 0.5F, 1, 1.5F}));
    }
}

TEST_P(RosTypes, LaserScans) {
  const float infinity = std::numeric_limits<float>::infinity();
  RosBytes bytes = message();
  bytes.header(1, 0, "laser");
  for (const float value : {-1.5F, 1.5F, 0.75F, 0.25F, 1.0F, 0.5F, 10.0F}) bytes.f32(value);
  bytes.u32(5);
  for (const float range : {2.0F, 0.1F, 4.0F, infinity, 11.0F}) bytes.f32(range);
  bytes.u32(5);
  for (const float intensity : {7.0F, 1.0F, 9.0F, 2.0F, 3.0F}) bytes.f32(intensity);
  const RosChannel laser = channel("sensor_msgs/LaserScan");
  const RosScan scan = read_ros_scan(as(laser, bytes));
  EXPECT_EQ(scan.range_max_m, 10);
  ASSERT_EQ(scan.scan.points.size(), 2U) << "the others are too near, too far or none";
  EXPECT_NEAR(static_cast<double>(scan.scan.points[0].x()), 2 * std::cos(1.5), 1e-6);
  EXPECT_NEAR(static_cast<double>(scan.scan.points[0].y()), -2 * std::sin(1.5), 1e-6);
  EXPECT_LT((scan.scan.points[1] - Eigen::Vector3f(4, 0, 0)).norm(), 1e-6);
  EXPECT_EQ(scan.scan.times_s, (std::vector<float>{0, 0.5F}));
  EXPECT_EQ(scan.scan.intensities, (std::vector<float>{7, 9}));
}

/// Drivers that do not know a scanner's maximum range leave it at zero.
TEST_P(RosTypes, LaserScansWithoutALargestRange) {
  RosBytes bytes = message();
  bytes.header(1, 0, "laser");
  for (const float value : {0.0F, 1.0F, 1.0F, 0.0F, 0.0F, 0.0F, 0.0F}) bytes.f32(value);
  bytes.u32(2).f32(2).f32(400).u32(0);
  const RosChannel laser = channel("sensor_msgs/LaserScan");
  const RosScan scan = read_ros_scan(as(laser, bytes));
  EXPECT_EQ(scan.scan.points.size(), 2U);
  EXPECT_EQ(scan.range_max_m, 0) << "not stated";
  EXPECT_TRUE(scan.scan.intensities.empty());
}

TEST_P(RosTypes, LivoxPoints) {
  RosBytes bytes = message();
  bytes.header(1, 0, "livox").u64(1'000'000'000).u32(2).u8(7).u8(0).u8(0).u8(0).u32(2);
  bytes.u32(0).f32(1).f32(2).f32(3).u8(9).u8(9).u8(9);
  bytes.u32(50'000'000).f32(4).f32(5).f32(6).u8(9).u8(9).u8(9);
  for (const char* type : {"livox_ros_driver/CustomMsg", "livox_ros_driver2/CustomMsg"}) {
    const RosChannel livox = channel(type);
    ASSERT_TRUE(is_scan_type(type));
    const RosScan scan = read_ros_scan(as(livox, bytes));
    EXPECT_EQ(scan.header.frame, "livox");
    ASSERT_EQ(scan.scan.points.size(), 2U);
    EXPECT_EQ(scan.scan.points[1], Eigen::Vector3f(4, 5, 6));
    EXPECT_EQ(scan.scan.times_s, (std::vector<float>{0, 0.05F}));
    EXPECT_FALSE(read_ros_point_times(as(livox, bytes))) << "their unit is known";
  }
}

/// Without a stamp in the header, absolute times are relative to the recording time.
TEST_P(RosTypes, TimesOfACloudWithoutATimeOfItsOwn) {
  RosBytes bytes = message();
  bytes.header(0, 0, "os").u32(1).u32(1).u32(4);
  bytes.text("x").u32(0).u8(7).u32(1).text("y").u32(0).u8(7).u32(1).text("z").u32(0).u8(7).u32(1);
  bytes.text("timestamp").u32(4).u8(8).u32(1);
  RosBytes record(MessageEncoding::kRos1);
  record.f32(1).f64(1'700'000'000.25);
  bytes.u8(0).u32(12).u32(12).u32(12).raw(record.bytes()).u8(1);
  const RosChannel points = channel("sensor_msgs/PointCloud2");
  const RosMessage recorded{points, {1'700'000'000'000'000'000}, bytes.bytes(), "x.mcap"};
  EXPECT_EQ(read_ros_scan(recorded).scan.times_s, std::vector<float>{0.25F});
  EXPECT_EQ(read_ros_scan(recorded).clock, PointClock::kScans);
}

RosBytes inertial(RosBytes bytes, double rate_covariance, double force_covariance) {
  bytes.header(1, 5, "imu").f64s({9, 9, 9, 9}).f64(-1).f64s(std::vector<double>(8)).f64s({1, 2, 3});
  bytes.f64(rate_covariance).f64s(std::vector<double>(8)).f64s({4, 5, 6});
  return bytes.f64(force_covariance).f64s(std::vector<double>(8));
}

TEST_P(RosTypes, InertialReadings) {
  const RosChannel imu = channel("sensor_msgs/Imu");
  EXPECT_FALSE(read_ros_imu(as(imu, inertial(message(), -1, 6))).is_complete);
  EXPECT_FALSE(read_ros_imu(as(imu, inertial(message(), 7, -1))).is_complete);
  const RosImu reading = read_ros_imu(as(imu, inertial(message(), 7, 6)));
  EXPECT_TRUE(reading.is_complete) << "a missing orientation does not matter";
  EXPECT_EQ(reading.angular_rate_radps, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(reading.specific_force_mps2, Eigen::Vector3d(4, 5, 6));
}

RosBytes fix(RosBytes bytes, unsigned status, double height_m, unsigned covariance_type) {
  bytes.header(1, 0, "gps").u8(status).u16(1).f64s({48, 11, height_m});
  return bytes.f64s({1, 0, 0, 0, 4, 0, 0, 0, 9}).u8(covariance_type);
}

TEST_P(RosTypes, PositionFixes) {
  const RosChannel gnss = channel("sensor_msgs/NavSatFix");
  const RosFix whole = read_ros_fix(as(gnss, fix(message(), 0, 500, 2)));
  EXPECT_EQ(whole.header.frame, "gps");
  ASSERT_TRUE(whole.place);
  EXPECT_NEAR(whole.place->latitude_rad, 48 * std::acos(-1.0) / 180, 1e-12);
  EXPECT_NEAR(whole.place->longitude_rad, 11 * std::acos(-1.0) / 180, 1e-12);
  EXPECT_EQ(whole.place->height_m, 500);
  EXPECT_EQ(whole.sigma_m, 3);
  EXPECT_EQ(read_ros_fix(as(gnss, fix(message(), 0, std::nan(""), 2))).sigma_m, 2) << "of east and north";
  EXPECT_FALSE(read_ros_fix(as(gnss, fix(message(), 255, 500, 2))).place) << "status -1: no fix";
  EXPECT_FALSE(read_ros_fix(as(gnss, fix(message(), 0, 1e9, 2))).place);
  EXPECT_FALSE(read_ros_fix(as(gnss, fix(message(), 0, 500, 0))).sigma_m) << "not known";
}

TEST_P(RosTypes, RefusesWhatEndsEarly) {
  const std::string whole = cloud(message(), ByteOrder::kLittle, "os").bytes();
  const RosChannel points = channel("sensor_msgs/PointCloud2");
  for (std::size_t size = 0; size < whole.size() - 1; ++size)
    EXPECT_NE(refusal([&] {
                read_ros_scan({points, {}, std::string_view(whole).substr(0, size), "x.mcap"});
              }).find("x.mcap: a message of /topic, at its byte "),
              std::string::npos)
        << size;
  RosBytes many = message();
  many.u32(4'000'000'000);
  const RosChannel tf = channel("tf2_msgs/TFMessage");
  expect_refusal([&] { read_ros_transforms(as(tf, many)); }, 0, "within its 4000000000 elements");
}

TEST_P(RosTypes, RefusesCloudsThatContradictThemselves) {
  const RosChannel points = channel("sensor_msgs/PointCloud2");
  const auto with_size = [](std::uint64_t height, std::uint64_t width, std::uint64_t step) {
    RosBytes bytes = message();
    bytes.header(1, 0, "os").u32(height).u32(width).u32(1).text("x").u32(0).u8(7).u32(1);
    return bytes.u8(0).u32(step).u32(step * width + 1000).u32(4).raw("1234").u8(1);
  };
  EXPECT_TRUE(read_ros_scan(as(points, with_size(1, 0, 4))).scan.points.empty());
  EXPECT_TRUE(read_ros_scan(as(points, with_size(1000, 0, 4))).scan.points.empty());
  expect_refusal([&] { read_ros_scan(as(points, with_size(1, 1, 4))); }, 0, "the points have no y");
  expect_refusal([&] { read_ros_scan(as(points, with_size(1, 2, 4))); }, 0, "fewer points than");
  expect_refusal([&] { read_ros_scan(as(points, with_size(4'000'000'000, 4'000'000'000, 0))); }, 0,
                 "fewer points");
}

TEST(RosMessageReader, RefusesOtherEncapsulations) {
  const RosChannel channel{"/topic", "x/Y", MessageEncoding::kCdr};
  expect_refusal(
      [&] {
        RosMessageReader({channel, {}, std::string_view("\0\3\0\0", 4), "x"});
      },
      0, "plain CDR");
}

}  // namespace
}  // namespace radioslam
