#include "radioslam/io/ros/ros_topics.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <utility>

#include "radioslam/base/input_error.hpp"
#include "radioslam/base/units.hpp"
#include "radioslam/io/ros/ros_recording.hpp"
#include "radioslam/io/ros/ros_types.hpp"
#include "radioslam/io/ros/wifi_message.hpp"
#include "radioslam/io/text/skipped_records.hpp"

namespace radioslam {
namespace {

using TopicsByName = std::map<std::string, RosTopic>;

/// Whether messages of this type begin with a header.
bool has_header(const std::string& type) {
  return is_pose_type(type) || type == kImuType || type == kFixType || type == kRangeType ||
         is_scan_type(type);
}

constexpr std::int64_t kMaxDelay_ns = kNanosecondsPerSecond;

/// Indexes the messages of a recording one by one.
class TopicIndexer {
 public:
  /// Headers are read until one has a stamp.
  bool reads(const RosChannel& channel) const {
    if (is_transforms_type(channel.type)) return true;
    const auto topic = topics_.find(channel.topic);
    return has_header(channel.type) && (topic == topics_.end() || !topic->second.has_stamps);
  }

  void take(const RosMessage& message) {
    const bool is_read = reads(message.channel);
    RosTopic& topic =
        topics_.try_emplace(message.channel.topic, RosTopic{message.channel.topic, message.channel.type})
            .first->second;
    if (topic.messages++ == 0) topic.definition = message.channel.definition;
    if (!is_read) return;
    try {
      if (is_transforms_type(topic.type))
        fixed_.take(message);
      else
        note_header(message, topic);
    } catch (const InputError& error) {
      if (is_transforms_type(topic.type)) unreadable_[topic.name].add(error);
    }
  }

  RosTopicIndex finish(std::vector<std::string> warnings) {
    RosTopicIndex index;
    index.warnings = std::move(warnings);
    for (const auto& [topic, skipped] : unreadable_)
      index.warnings.push_back(skipped.warning(topic, "message"));
    index.frames = fixed_.tree();
    for (const auto& named : topics_) index.topics.push_back(named.second);
    if (!delays_ns_.empty()) {
      const auto middle = delays_ns_.begin() + std::ssize(delays_ns_) / 2;
      std::nth_element(delays_ns_.begin(), middle, delays_ns_.end());
      if (std::abs(*middle) > kMaxDelay_ns) index.recording_delay = {*middle};
    }
    return index;
  }

 private:
  /// Reads the frames and the stamp of a topic's first messages.
  void note_header(const RosMessage& message, RosTopic& topic) {
    RosMessageReader reader(message);
    const RosHeader header = reader.header();
    const std::string child = topic.type == kOdometryType ? reader.frame() : "";
    if (topic.frame.empty()) topic.frame = header.frame;
    if (topic.child.empty()) topic.child = child;
    topic.has_stamps = header.stamp != Stamp{};
    if (topic.has_stamps) delays_ns_.push_back(message.stamp.ns - header.stamp.ns);
  }

  TopicsByName topics_;
  FixedTransforms fixed_;
  std::map<std::string, SkippedRecords> unreadable_;  ///< transforms, by topic
  std::vector<std::int64_t> delays_ns_;               ///< from stamp to recording, one per topic
};

constexpr const char* kNoTopic = "none";

using IsOfKind = bool (*)(const RosTopic& topic);

bool has_odometry(const RosTopic& topic) { return topic.type == kOdometryType; }
bool has_poses(const RosTopic& topic) { return is_pose_type(topic.type); }
bool has_scans(const RosTopic& topic) { return is_scan_type(topic.type); }
bool has_fixes(const RosTopic& topic) { return topic.type == kFixType; }
bool has_inertial(const RosTopic& topic) { return topic.type == kImuType; }
bool has_wifi(const RosTopic& topic) { return wifi_definition_of(topic).has_value(); }

/// One kind of topics and the option that selects one.
struct TopicKind {
  const char* option;
  const char* what;
  IsOfKind is_found;    ///< topics that are used by default if there is only one
  IsOfKind is_allowed;  ///< topics that may be selected
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
      if (kind.is_found(topic) && topic.name != other) found.push_back(topic);
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
    if (!kind.is_allowed(*topic))
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
  TopicIndexer indexer;
  auto warnings = visit_recording(source, {[&](const RosChannel& channel) { return indexer.reads(channel); },
                                           [&](const RosMessage& message) { indexer.take(message); }});
  RosTopicIndex index = indexer.finish(std::move(warnings));
  if (index.topics.empty() && !index.warnings.empty())
    throw InputError(source.string(), 0, "has no readable messages: " + index.warnings.front());
  return index;
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
  const IsOfKind none = [](const RosTopic&) { return false; };
  const TopicChooser chooser(source, survey);
  RosTopicChoice choice;
  choice.truth = chooser.choose_poses({"--truth", "poses", none, has_poses}, wishes.truth, "");
  const std::string truth = choice.truth ? choice.truth->topic : "";
  choice.odometry =
      chooser.choose_poses({"--odometry", "odometry", has_odometry, has_poses}, wishes.odometry, truth);
  choice.scans = chooser.choose({"--scans", "laser scans", has_scans, has_scans}, wishes.scans, "");
  choice.imu = chooser.choose({"--imu", "IMU samples", has_inertial, has_inertial}, wishes.imu, "");
  choice.gnss = chooser.choose({"--gnss", "position fixes", has_fixes, has_fixes}, wishes.gnss, "");
  choice.wifi = chooser.choose({"--wifi", "WiFi readings", has_wifi, has_wifi}, wishes.wifi, "");
  if (!choice.odometry && !choice.scans)
    chooser.fail_with_topics(
        "has neither odometry nor laser scans to import; --odometry selects a topic of poses, or "
        "/tf:FRAME.CHILD");
  return choice;
}

}  // namespace radioslam
