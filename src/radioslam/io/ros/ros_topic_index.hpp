// Index of a ROS recording: its topics with their frames, and its static transforms.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "radioslam/io/ros/frame_tree.hpp"

namespace radioslam {

struct RosTopic {
  std::string name;
  std::string type;
  std::size_t messages = 0;
  std::string frame = {};  ///< frame of its first message, for importable types
  std::string child = {};  ///< child frame of its first message, for nav_msgs/Odometry
};

struct RosTopicIndex {
  std::vector<RosTopic> topics;  ///< topics with messages, sorted by name
  FrameTree frames;              ///< static transforms (fixed_transforms.hpp)
  std::vector<std::string> warnings;

  /// The topic of this name; null if there is none.
  const RosTopic* find(const std::string& name) const;
};

/// Reads the recording once. Refuses whatever visit_recording and the readers of the messages refuse.
RosTopicIndex index_recording(const std::filesystem::path& source);

/// "/odom (nav_msgs/Odometry, 345), ...", for messages.
std::string list_of_topics(const std::vector<RosTopic>& topics);

}  // namespace radioslam
