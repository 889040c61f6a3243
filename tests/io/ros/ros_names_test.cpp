#include "radioslam/io/ros/ros_names.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

TEST(RosNames, AreThoseOfRos) {
  for (const char* name : {"odom", "/odom", "/a/odom", "a_b/c1", "_hidden"})
    EXPECT_EQ(problem_with_ros_name(name), "") << name;
  for (const char* name : {"", "/", "/a/", "a//b", "1a", "a/2b", "a-b", "a b", "a__b", "~/a", "a.b"})
    EXPECT_NE(problem_with_ros_name(name), "") << name;
  EXPECT_NE(problem_with_ros_name(std::string(300, 'a')), "");
}

TEST(RosNames, AreRelativeToTheNamespace) {
  EXPECT_EQ(resolved_ros_name("odom", "/a"), "/a/odom");
  EXPECT_EQ(resolved_ros_name("/odom", "/a"), "/odom");
  EXPECT_EQ(resolved_ros_name("odom", ""), "/odom");
}

TEST(RosNames, AreMadeOfRobots) {
  for (const auto& [robot, name] : {std::pair("a", "a"), std::pair("robot-1", "robot_1"),
                                    std::pair("1", "_1"), std::pair("a.-b", "a_b")}) {
    EXPECT_EQ(as_ros_name(robot), name);
    EXPECT_EQ(problem_with_ros_name(as_ros_name(robot)), "") << robot;
  }
}

}  // namespace
}  // namespace radioslam
