// Names of topics as ROS 2 has them (design.ros2.org, "Topic and Service name mapping to DDS"): parts of
// letters, digits and '_', none of which begins with a digit, separated by '/'. Names that begin with '/' are
// absolute, others relative to a namespace.
#pragma once

#include <string>
#include <string_view>

namespace radioslam {

/// Why the text is no name of a topic, in words that follow it; empty if it is one.
std::string problem_with_ros_name(std::string_view name);

/// "odom" in "/a" is "/a/odom"; an absolute name stays. Needs a name.
std::string resolved_ros_name(std::string_view name, std::string_view space);

/// The text as one part of a name: what ROS does not allow is '_', and a digit in front gets one before it.
std::string as_ros_name(std::string_view text);

}  // namespace radioslam
