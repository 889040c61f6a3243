// What a ROS recording holds: its topics, their frames and the fixed transforms, before anything is
// imported.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "radioslam/io/frame_tree.hpp"

namespace radioslam {

struct RosTopic {
  std::string name;
  std::string type;
  std::size_t messages = 0;
  std::string frame = {};  ///< of its first message, where its type is one that a mission is made of
  std::string child = {};  ///< likewise, of a nav_msgs/Odometry
};

struct RosSurvey {
  std::vector<RosTopic> topics;  ///< that have messages, by name
  FrameTree frames;              ///< that never move (fixed_transforms.hpp)
  std::vector<std::string> warnings;

  /// Nothing (null) where there is no such topic.
  const RosTopic* find(const std::string& name) const;
};

/// Goes through the recording once. Refuses what visit_recording and the messages' readers refuse.
RosSurvey survey_recording(const std::filesystem::path& source);

/// "/odom (nav_msgs/Odometry, 345)", one after the other; for messages.
std::string list_of_topics(const std::vector<RosTopic>& topics);

}  // namespace radioslam
