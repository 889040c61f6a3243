#include "radioslam/io/dds/dds_names.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

TEST(DdsNames, AreThoseOfRos2) {
  EXPECT_EQ(dds_topic("/a/odom"), "rt/a/odom");
  EXPECT_EQ(dds_topic("odom"), "rt/odom");
  EXPECT_EQ(ros_topic("rt/a/odom"), "/a/odom");
  EXPECT_EQ(dds_type("nav_msgs/msg/Odometry"), "nav_msgs::msg::dds_::Odometry_");
  EXPECT_EQ(dds_type("nav_msgs/Odometry"), "nav_msgs::msg::dds_::Odometry_");
  EXPECT_EQ(ros_type("nav_msgs::msg::dds_::Odometry_"), "nav_msgs/msg/Odometry");
}

TEST(DdsNames, OthersStayAsTheyAre) {
  EXPECT_EQ(ros_topic("ros_discovery_info"), "ros_discovery_info");
  EXPECT_EQ(ros_type("Shape"), "Shape");
  EXPECT_EQ(dds_type("Shape"), "Shape");
}

}  // namespace
}  // namespace radioslam
