#include "radioslam/io/ros/ros_topics.hpp"

#include <algorithm>
#include <map>

#include "radioslam/base/input_error.hpp"
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

constexpr const char* kNoTopic = "none";

using IsOfKind = bool (*)(std::string_view type);

bool is_odometry_type(std::string_view type) { return type == kOdometryType; }
bool is_fix_type(std::string_view type) { return type == kFixType; }
bool is_inertial_type(std::string_view type) { return type == kImuType; }

/// One kind of topics and the option that selects one.
struct TopicKind {
  const char* option;
  const char* what;
  IsOfKind is_found;    ///< types that are used by default if there is only one topic
  IsOfKind is_allowed;  ///< types that may be selected
};

class TopicChooser {
 public:
  TopicChooser(const std::string& source, const RosTopicIndex& survey) : source_(source), survey_(survey) {}

  /// The selected topic, or the only one of the kind other than `other`.
  std::optional<std::string> choose(const TopicKind& kind, const std::string& wish,
                                    const std::string& other) const {
    if (wish == kNoTopic) return std::nullopt;
    if (!wish.empty()) return asked_for(kind, wish);
    std::vector<RosTopic> found;
    for (const RosTopic& topic : survey_.topics)
      if (kind.is_found(topic.type) && topic.name != other) found.push_back(topic);
    if (found.size() > 1)
      fail("has " + std::to_string(found.size()) + " topics with " + kind.what + "; " + kind.option +
           " selects one of them, or none: " + list_of_topics(found));
    return found.empty() ? std::nullopt : std::optional(found.front().name);
  }

  std::optional<RosPoseTopic> choose_poses(const TopicKind& kind, const std::string& wish,
                                           const std::string& other) const {
    if (const auto transforms = asked_for_transforms(kind, wish)) return transforms;
    const auto topic = choose(kind, wish, other);
    return topic ? std::optional(RosPoseTopic{*topic}) : std::nullopt;
  }

  [[noreturn]] void fail(const std::string& reason) const { throw InputError(source_, 0, reason); }
  [[noreturn]] void fail_with_topics(const std::string& reason) const {
    fail(reason + "; the recording has " + list_of_topics(survey_.topics));
  }

 private:
  std::string asked_for(const TopicKind& kind, const std::string& wish) const {
    const RosTopic* topic = survey_.find(wish);
    if (topic == nullptr) fail_with_topics(std::string(kind.option) + ": unknown topic " + wish);
    if (is_transforms_type(topic->type))
      fail(std::string(kind.option) + ": " + wish + " has transforms; " + wish + ":FRAME.CHILD selects one");
    if (!kind.is_allowed(topic->type))
      fail_with_topics(std::string(kind.option) + ": " + wish + " has type " + topic->type +
                       ", which is not one of " + kind.what);
    return wish;
  }

  /// "/tf:odom.base_link": two frames of a topic of transforms.
  std::optional<RosPoseTopic> asked_for_transforms(const TopicKind& kind, const std::string& wish) const {
    const std::size_t colon = wish.rfind(':');
    if (colon == std::string::npos) return std::nullopt;
    const RosTopic* topic = survey_.find(wish.substr(0, colon));
    const std::string frames = wish.substr(colon + 1);
    const std::size_t point = frames.find('.');
    if (topic == nullptr || !is_transforms_type(topic->type))
      fail_with_topics(std::string(kind.option) + ": unknown topic of transforms " + wish.substr(0, colon));
    if (point == std::string::npos)
      fail(std::string(kind.option) + " " + wish + ": expected two frames separated by a point");
    return RosPoseTopic{topic->name, frames.substr(0, point), frames.substr(point + 1)};
  }

  const std::string& source_;
  const RosTopicIndex& survey_;
};

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

RosTopicChoice choose_topics(const std::string& source, const RosTopicIndex& survey,
                             const RosTopicRequest& wishes) {
  const IsOfKind none = [](std::string_view) { return false; };
  const TopicChooser chooser(source, survey);
  RosTopicChoice choice;
  choice.truth = chooser.choose_poses({"--truth", "poses", none, is_pose_type}, wishes.truth, "");
  const std::string truth = choice.truth ? choice.truth->topic : "";
  choice.odometry = chooser.choose_poses({"--odometry", "odometry", is_odometry_type, is_pose_type},
                                         wishes.odometry, truth);
  choice.scans = chooser.choose({"--scans", "laser scans", is_scan_type, is_scan_type}, wishes.scans, "");
  choice.imu = chooser.choose({"--imu", "IMU samples", is_inertial_type, is_inertial_type}, wishes.imu, "");
  choice.gnss = chooser.choose({"--gnss", "position fixes", is_fix_type, is_fix_type}, wishes.gnss, "");
  if (!choice.odometry && !choice.scans)
    chooser.fail_with_topics(
        "has neither odometry nor laser scans to import; --odometry selects a topic of poses, or "
        "/tf:FRAME.CHILD");
  return choice;
}

}  // namespace radioslam
