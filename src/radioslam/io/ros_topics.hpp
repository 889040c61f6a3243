// Which topics of a ROS recording a mission is made of.
#pragma once

#include <optional>
#include <string>

#include "radioslam/io/ros_survey.hpp"

namespace radioslam {

/// As a user asks for them: a topic; a topic of transforms with the two frames, "/tf:odom.base_link"; "none";
/// or empty, where the only one of its kind is taken (of odometry, scans, inertial readings and position
/// fixes) or none (of the truth: a pose may as well be a goal or somebody's estimate).
struct RosTopicWishes {
  std::string odometry = {}, scans = {}, imu = {}, truth = {}, gnss = {};
};

/// Where poses are taken from.
struct RosPoseTopic {
  std::string topic;
  std::string frame = {}, child = {};  ///< of a topic of transforms, those that are meant
};

struct RosTopicChoice {
  std::optional<RosPoseTopic> odometry, truth;
  std::optional<std::string> scans, imu, gnss;
};

/// Refuses (InputError on `source`, with the topics there are) a topic that is not there or is of another
/// kind, several of one kind where none is asked for, and a recording with neither odometry nor scans.
RosTopicChoice choose_topics(const std::string& source, const RosSurvey& survey,
                             const RosTopicWishes& wishes);

}  // namespace radioslam
