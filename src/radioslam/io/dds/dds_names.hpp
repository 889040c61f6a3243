// Names of ROS 2 topics and types, and those by which DDS knows them:
//   /a/odom                 rt/a/odom
//   nav_msgs/msg/Odometry   nav_msgs::msg::dds_::Odometry_
// Names that follow no such rule are the same on both sides.
#pragma once

#include <string>
#include <string_view>

namespace radioslam {

std::string dds_topic(std::string_view ros_topic);
/// Of "nav_msgs/msg/Odometry" or, as in recordings of ROS 1, "nav_msgs/Odometry".
std::string dds_type(std::string_view ros_type);
std::string ros_topic(std::string_view dds_topic);
std::string ros_type(std::string_view dds_type);

}  // namespace radioslam
