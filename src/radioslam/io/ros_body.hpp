// Which frame of a ROS recording is the body's, and where a sensor is in it.
//
// The body is what the odometry says moves (its child frame), else base_link or base_footprint where a fixed
// transform knows it; else nothing tells it. A sensor that no fixed transform leads to is taken to be at the
// body's origin, and a warning says so.
#pragma once

#include <string>
#include <vector>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/io/ros_topics.hpp"

namespace radioslam {

/// The body's frame, "" where nothing tells it.
std::string body_frame(const RosSurvey& survey, const RosTopicChoice& choice);

/// T_body_sensor of a topic; `warnings` tell what it is taken from.
SE3 place_of_sensor(const RosSurvey& survey, const std::string& body, const std::string& topic,
                    std::vector<std::string>& warnings);

}  // namespace radioslam
