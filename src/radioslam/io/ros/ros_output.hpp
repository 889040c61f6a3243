// Messages of ROS 2 as this program publishes and records them: their CDR, and their definitions as
// recordings have them.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/io/ros/cdr_writer.hpp"
#include "radioslam/io/ros/ros_types.hpp"
#include "radioslam/results/map_result.hpp"

namespace radioslam {

/// A message on its way to whoever listens or records.
struct RosPublication {
  std::string topic;       ///< "/a/radioslam/odom"
  std::string type;        ///< "nav_msgs/msg/Odometry"
  std::string definition;  ///< that of the type, and behind it those of the types in it
  Stamp stamp;
  std::string cdr;
};

/// T_frame_child at a time.
struct RosTransform {
  Stamp stamp;
  std::string frame, child;
  SE3 pose;
};

/// Line segments of one colour, red, green and blue from 0 to 1.
struct RosLines {
  std::string name;
  Eigen::Vector3f colour;
  double width_m = 0.05;
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> segments;
};

void write_header(CdrWriter& out, const RosHeader& header);

/// Covariances and velocities are not stated: zero.
std::string odometry_cdr(const RosTransform& pose);
std::string transforms_cdr(const std::vector<RosTransform>& transforms);
std::string path_cdr(const RosHeader& header, const std::vector<StampedPose<SE3>>& poses);
/// Cells are 100 where occupied, 0 where free, -1 where unknown.
std::string grid_cdr(const RosHeader& header, const OccupancyGrid& grid);
/// Fields x, y, z and intensity, 32 bits each.
std::string cloud_cdr(const RosHeader& header, const std::vector<MapPoint>& points);
/// Replaces lines of the same names.
std::string lines_cdr(const RosHeader& header, const std::vector<RosLines>& lines);

/// Of one of the types above and those in them: "nav_msgs/msg/Odometry".
std::string ros_definition_of(std::string_view type);

}  // namespace radioslam
