// Determines the body frame of a ROS recording, and the extrinsics of its sensors.
//
// The body frame is the child frame of the odometry, otherwise base_link or base_footprint if a static
// transform names it; otherwise it is unknown. A sensor without a chain of static transforms to the body is
// assumed to be at the body's origin, with a warning.
#pragma once

#include <string>
#include <vector>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/io/ros/ros_topics.hpp"

namespace radioslam {

/// The body frame; empty if it is unknown.
std::string body_frame(const RosTopicIndex& survey, const RosTopicChoice& choice);

/// T_body_sensor of a topic. Adds a warning if it has to be assumed.
SE3 extrinsics_of(const RosTopicIndex& survey, const std::string& body, const std::string& topic,
                  std::vector<std::string>& warnings);

}  // namespace radioslam
