#include "radioslam/io/ros/ros_topic_index.hpp"

#include <algorithm>
#include <map>

#include "radioslam/io/ros/fixed_transforms.hpp"
#include "radioslam/io/ros/ros_recording.hpp"
#include "radioslam/io/ros/ros_types.hpp"

namespace radioslam {
namespace {

using TopicsByName = std::map<std::string, RosTopic>;

bool has_a_frame(const RosChannel& channel) {
  return channel.type == kOdometryType || channel.type == kImuType || channel.type == kFixType ||
         is_scan_type(channel.type);
}

/// Reads the frames in a topic's first message.
void note_frames(const RosMessage& message, RosTopic& topic) {
  RosMessageReader reader(message);
  topic.frame = reader.header().frame;
  if (topic.type == kOdometryType) topic.child = reader.frame();
}

}  // namespace

const RosTopic* RosTopicIndex::find(const std::string& name) const {
  const auto found =
      std::find_if(topics.begin(), topics.end(), [&](const RosTopic& topic) { return topic.name == name; });
  return found == topics.end() ? nullptr : &*found;
}

RosTopicIndex index_recording(const std::filesystem::path& source) {
  RosTopicIndex survey;
  FixedTransforms fixed;
  TopicsByName topics;
  RosVisitor visitor;
  visitor.reads = [&](const RosChannel& channel) {
    return is_transforms_type(channel.type) || (has_a_frame(channel) && !topics.contains(channel.topic));
  };
  visitor.take = [&](const RosMessage& message) {
    const auto [topic, is_new] =
        topics.try_emplace(message.channel.topic, RosTopic{message.channel.topic, message.channel.type});
    ++topic->second.messages;
    if (is_transforms_type(message.channel.type)) fixed.take(message);
    if (is_new && has_a_frame(message.channel)) note_frames(message, topic->second);
  };
  survey.warnings = visit_recording(source, visitor);
  survey.frames = fixed.tree();
  for (const auto& named : topics) survey.topics.push_back(named.second);
  return survey;
}

std::string list_of_topics(const std::vector<RosTopic>& topics) {
  std::string list;
  for (const RosTopic& topic : topics)
    list += (list.empty() ? "" : ", ") + topic.name + " (" + topic.type + ", " +
            std::to_string(topic.messages) + ")";
  return list.empty() ? "none" : list;
}

}  // namespace radioslam
