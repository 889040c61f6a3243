// Messages that are published: read as this program reads such of others, and byte by byte as their
// definitions have them.
#include "radioslam/io/ros/ros_output.hpp"

#include <gtest/gtest.h>

#include "radioslam/io/ros/ros_definition.hpp"

namespace radioslam {
namespace {

const SE3 kPose({1, 2, 3}, Eigen::Quaterniond(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ())));
const RosHeader kHeader{{100'000'000'005}, "a/map"};

RosMessage message(const RosChannel& channel, const std::string& cdr) {
  return {channel, Stamp{}, cdr, "bytes"};
}

/// The numbers and texts as the type's definition reads them, which must be all bytes.
std::size_t expect_as_defined(const std::string& type, const std::string& cdr) {
  const std::string definition = ros_definition_of(type);
  const RosChannel channel{"/a", short_type(type), MessageEncoding::kCdr, definition};
  const auto parsed = RosDefinition::parse(short_type(type), definition);
  EXPECT_TRUE(parsed) << type;
  if (!parsed) return 0;
  std::size_t values = 0;
  parsed->read(message(channel, cdr), [&](const RosValue&) { ++values; });
  for (std::size_t missing = 1; missing <= 1; ++missing)
    EXPECT_THROW(parsed->read(message(channel, cdr.substr(0, cdr.size() - missing)), [](const RosValue&) {}),
                 std::exception)
        << type << " has bytes that its definition does not have";
  return values;
}

TEST(RosOutput, OdometryIsReadAsSuch) {
  const std::string cdr = odometry_cdr({kHeader.stamp, "a/odom", "a/base_link", kPose});
  const RosChannel channel{"/a", "nav_msgs/Odometry"};
  const RosPose pose = read_ros_pose(message(channel, cdr));
  EXPECT_EQ(pose.header.stamp, kHeader.stamp);
  EXPECT_EQ(pose.header.frame + ' ' + pose.child, "a/odom a/base_link");
  EXPECT_LT((pose.pose->inverse() * kPose).log().norm(), 1e-12);
  EXPECT_EQ(expect_as_defined("nav_msgs/msg/Odometry", cdr), 3U + 7 + 36 + 6 + 36);
}

TEST(RosOutput, TransformsAreReadAsSuch) {
  const std::string cdr =
      transforms_cdr({{kHeader.stamp, "a/map", "a/odom", kPose}, {{7}, "a/odom", "a", {}}});
  const RosChannel channel{"/tf", "tf2_msgs/TFMessage"};
  const auto transforms = read_ros_transforms(message(channel, cdr));
  ASSERT_EQ(transforms.size(), 2U);
  EXPECT_EQ(transforms[0].child, "a/odom");
  EXPECT_LT((transforms[0].pose->inverse() * kPose).log().norm(), 1e-12);
  EXPECT_EQ(transforms[1].header.stamp, Stamp{7});
  EXPECT_EQ(expect_as_defined("tf2_msgs/msg/TFMessage", cdr), 2 * (3U + 7));
}

TEST(RosOutput, CloudsAreReadAsScans) {
  MapPoint point;
  point.position = {1, 2, 3};
  point.intensity = 7;
  MapPoint other = point;
  other.position.x() = -4;
  other.intensity = 8;
  const std::string cdr = cloud_cdr(kHeader, {point, other});
  const RosChannel channel{"/map", "sensor_msgs/PointCloud2"};
  const RosScan scan = read_ros_scan(message(channel, cdr));
  ASSERT_EQ(scan.scan.points.size(), 2U);
  EXPECT_EQ(scan.scan.points[1], Eigen::Vector3f(-4, 2, 3));
  EXPECT_EQ(scan.scan.intensities, (std::vector<float>{7, 8}));
  expect_as_defined("sensor_msgs/msg/PointCloud2", cdr);
}

TEST(RosOutput, GridsHaveTheValuesOfRos) {
  OccupancyGrid grid{0.1, {-1, 2}, 3, 1, {CellState::kUnknown, CellState::kFree, CellState::kOccupied}};
  const std::string cdr = grid_cdr(kHeader, grid);
  std::vector<double> cells;
  const auto definition = ros_definition_of("nav_msgs/msg/OccupancyGrid");
  const RosChannel channel{"/grid", "nav_msgs/OccupancyGrid", MessageEncoding::kCdr, definition};
  RosDefinition::parse(channel.type, definition)->read(message(channel, cdr), [&](const RosValue& value) {
    if (value.name.starts_with("data")) cells.push_back(value.number);
  });
  EXPECT_EQ(cells, (std::vector<double>{-1, 0, 100}));
  expect_as_defined("nav_msgs/msg/OccupancyGrid", cdr);
}

TEST(RosOutput, PathsAndLinesAreAsDefined) {
  EXPECT_EQ(expect_as_defined("nav_msgs/msg/Path", path_cdr(kHeader, {{{1}, kPose}, {{2}, SE3()}})),
            2U + 2 * (2 + 7));
  const RosLines lines{"closures", {1, 0, 0}, 0.1, {{{0, 0, 0}, {1, 1, 0}}}};
  expect_as_defined("visualization_msgs/msg/MarkerArray",
                    lines_cdr(kHeader, {lines, {"none", {0, 1, 0}, 1, {}}}));
}

TEST(RosOutput, TimesBeforeTheFirstSecondAreWhole) {
  CdrWriter out;
  write_header(out, {{-1}, ""});
  const std::string cdr = out.take();
  const RosChannel channel{"/a", ""};
  EXPECT_EQ(RosMessageReader(message(channel, cdr)).header().stamp, Stamp{-1});
}

}  // namespace
}  // namespace radioslam
