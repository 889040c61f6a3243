// Chooses the topics of a ROS recording to import.
#pragma once

#include <optional>
#include <string>

#include "radioslam/io/ros/ros_topic_index.hpp"

namespace radioslam {

/// The user's choice of topics: a topic; a topic of transforms with two frames, "/tf:odom.base_link"; "none";
/// or empty. If it is empty, the only topic of the kind is used for odometry, scans, IMU samples and position
/// fixes, but none for the ground truth, because poses could also be goals or estimates.
struct RosTopicRequest {
  std::string odometry = {}, scans = {}, imu = {}, truth = {}, gnss = {};
};

/// The source of poses.
struct RosPoseTopic {
  std::string topic;
  std::string frame = {}, child = {};  ///< for a topic of transforms: the two frames
};

struct RosTopicChoice {
  std::optional<RosPoseTopic> odometry, truth;
  std::optional<std::string> scans, imu, gnss;
};

/// Refuses (InputError for `source`, listing its topics) a topic that does not exist or has the wrong type,
/// an ambiguous default, and a recording with neither odometry nor scans.
RosTopicChoice choose_topics(const std::string& source, const RosTopicIndex& survey,
                             const RosTopicRequest& wishes);

}  // namespace radioslam
