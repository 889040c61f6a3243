#include "radioslam/io/mission/odometry_table.hpp"

#include <gtest/gtest.h>

#include "io/refusal.hpp"
#include "radioslam/io/mission/recorded_odometry.hpp"

namespace radioslam {
namespace {

Trajectory<SE3> read(const std::string& content) {
  std::vector<std::string> warnings;
  return read_odometry_table(make_tool_output("odom.csv", content), warnings);
}

TEST(OdometryTable, ReadsPosesInManyTables) {
  for (const std::string content :
       {"1574407123.5 1 2 0 0 0 1 0\n1574407124.5 1 3 0 0 0 1 0\n",
        "1574407123.5,1,2,0,0,0,1,0\n1574407124.5,1,3,0,0,0,1,0\n",
        "t_s,x,y,yaw\n1574407123.5,1,2,3.14159265358979\n1574407124.5,1,3,3.14159265358979\n",
        "time;x_m;y_m;heading_deg\n1574407123,5;1;2;180\n1574407124,5;1;3;180\n",
        "%time,field.header.seq,field.header.stamp,field.pose.pose.position.x,field.pose.pose.position.y,"
        "field.pose.pose.position.z,field.pose.pose.orientation.x,field.pose.pose.orientation.y,"
        "field.pose.pose.orientation.z,field.pose.pose.orientation.w\n"
        "1574407123500000000,1,1574407123500000000,1,2,0,0,0,1,0\n"
        "1574407124500000000,2,1574407124500000000,1,3,0,0,0,1,0\n"}) {
    const Trajectory<SE3> poses = read(content);
    ASSERT_EQ(poses.size(), 2U) << content;
    EXPECT_EQ(poses[0].stamp, Stamp{1'574'407'123'500'000'000}) << content;
    EXPECT_EQ(poses[1].pose.translation(), Eigen::Vector3d(1, 3, 0)) << content;
    EXPECT_NEAR(std::abs(poses[1].pose.yaw()), 3.14159265, 1e-6) << content;
  }
}

TEST(OdometryTable, BeginsAtItsStart) {
  const Trajectory<SE3> odometry = [] {
    const Trajectory<SE3> poses = read("t_s,x,y,yaw\n0,1,2,1.5707963267949\n1,1,3,1.5707963267949\n");
    return from_start({poses.begin(), poses.end()});
  }();
  EXPECT_TRUE(odometry[0].pose.translation().isZero());
  EXPECT_TRUE(odometry[1].pose.translation().isApprox(Eigen::Vector3d(1, 0, 0), 1e-9));
  EXPECT_TRUE(is_in_plane(odometry));
  EXPECT_FALSE(is_in_plane(read("t,x,y,z,yaw\n0,0,0,0,0\n1,0,0,1,0\n")));
}

TEST(OdometryTable, RefusesOtherTables) {
  expect_refusal([&] { read("time,x,y\n0,1,2\n"); }, 1, "no columns of a time, x, y, and yaw");
  expect_refusal([&] { read("time,x,y,yaw\n0,1,two,3\n"); }, 2, "y");
  expect_refusal([&] { read("0 1 2 3\n"); }, 1, "");
}

}  // namespace
}  // namespace radioslam
