// Chooses the topics of a ROS recording to import.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/io/ros/transforms.hpp"

namespace radioslam {

/// Index of a ROS recording: its topics with their frames, and its static transforms.
struct RosTopic {
  std::string name;
  std::string type;
  std::size_t messages = 0;
  std::string frame = {};  ///< frame of its first message, for importable types
  std::string child = {};  ///< child frame of its first message, for nav_msgs/Odometry
  /// Whether any of its messages has a stamp, for importable types.
  bool has_stamps = false;
  std::string definition = {};  ///< text of its type's definition, if the recording has it
};

struct RosTopicIndex {
  std::vector<RosTopic> topics;  ///< topics with messages, sorted by name
  FrameTree frames;              ///< static transforms (FixedTransforms)
  std::vector<std::string> warnings;
  /// Typical time from a message's stamp to its recording, if that is more than a second: the recording was
  /// replayed, or its clocks differ. Messages of topics without stamps get the recording time less this.
  Stamp recording_delay;

  /// The topic of this name; null if there is none.
  const RosTopic* find(const std::string& name) const;
};

/// Reads the recording once. Refuses whatever visit_recording and the readers of the messages refuse.
RosTopicIndex index_recording(const std::filesystem::path& source);

/// "/odom (nav_msgs/Odometry, 345), ...", for messages.
std::string list_of_topics(const std::vector<RosTopic>& topics);

/// The user's choice of topics: a topic; a topic of transforms with two frames, "/tf:odom.base_link"; "none";
/// or empty. If it is empty, the only topic of the kind is used for odometry, scans, IMU samples, position
/// fixes and WiFi, but none for the ground truth, because poses could also be goals or estimates.
struct RosTopicRequest {
  std::string odometry = {}, scans = {}, imu = {}, truth = {}, gnss = {}, wifi = {};
};

/// The source of poses.
struct RosPoseTopic {
  std::string topic;
  std::string frame = {}, child = {};  ///< for a topic of transforms: the two frames
};

struct RosTopicChoice {
  std::optional<RosPoseTopic> odometry, truth;
  std::optional<std::string> scans, imu, gnss, wifi;
};

/// Refuses (InputError for `source`, listing its topics) a topic that does not exist or has the wrong type,
/// an ambiguous default, and a recording with neither odometry nor scans.
RosTopicChoice choose_topics(const std::string& source, const RosTopicIndex& survey,
                             const RosTopicRequest& wishes);

}  // namespace radioslam
