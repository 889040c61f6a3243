#include "radioslam/ros_node/robot_topics.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "radioslam/base/input_error.hpp"
#include "radioslam/io/ros/radioslam_messages.hpp"
#include "radioslam/io/ros/ros_names.hpp"

namespace radioslam {
namespace {

constexpr const char *kOption = "--topic", *kNowhere = "none", *kTransforms = "tf", *kClock = "clock";

struct KindFacts {
  RobotTopicKind kind;
  const char* name;
  std::vector<std::string_view> types;
  std::vector<const char*> nominal;  ///< names, relative to the robot
};

const std::vector<KindFacts>& all_kinds() {
  using Kind = RobotTopicKind;
  static const std::vector<KindFacts> kKinds{
      {Kind::kOdometry, "odometry", {kOdometryType}, {"odom"}},
      {Kind::kScans,
       "scans",
       {kPointCloudType, kLaserScanType, "livox_ros_driver2/CustomMsg"},
       {"points", "scan"}},
      {Kind::kImu, "imu", {kImuType}, {"imu", "imu/data"}},
      {Kind::kFix, "fix", {kFixType}, {"fix", "gps/fix"}},
      {Kind::kRanges, "ranges", {kRangeMeasurementType}, {"radioslam/ranges"}},
      {Kind::kAngles, "angles", {kAngleMeasurementType}, {"radioslam/angles"}},
      {Kind::kWifi, "wifi", {kWifiScanType}, {"radioslam/wifi"}},
      {Kind::kCsi, "csi", {kCsiPacketType}, {"radioslam/csi"}},
      {Kind::kRangeTo, "range", {kRangeType}, {}}};
  return kKinds;
}

const KindFacts& facts_of(RobotTopicKind kind) {
  return *std::find_if(all_kinds().begin(), all_kinds().end(),
                       [kind](const KindFacts& facts) { return facts.kind == kind; });
}

std::string absolute(const std::string& name, const std::string& space, const std::string& text) {
  if (const std::string problem = problem_with_ros_name(name); !problem.empty())
    throw InputError(kOption, 0, "'" + text + "': the name '" + name + "' " + problem);
  return resolved_ros_name(name, space);
}

/// "range:b" is the kind range with the partner b.
RobotTopic topic_of(const std::string& what, const std::string& text) {
  const std::size_t colon = what.find(':');
  const std::string name = what.substr(0, colon);
  const auto kind = std::find_if(all_kinds().begin(), all_kinds().end(),
                                 [&](const KindFacts& facts) { return facts.name == name; });
  if (kind == all_kinds().end())
    throw InputError(kOption, 0, "'" + text + "': no such kind; there are " + list_of_topic_kinds());
  RobotTopic topic{kind->kind, "", true};
  if (colon != std::string::npos) topic.partner = what.substr(colon + 1);
  if ((topic.kind == RobotTopicKind::kRangeTo) != !topic.partner.empty())
    throw InputError(kOption, 0,
                     "'" + text +
                         "': sensor_msgs/Range does not say to whom; range:PARTNER=NAME does, and no "
                         "other kind has a partner");
  return topic;
}

}  // namespace

std::string name_of(RobotTopicKind kind) { return facts_of(kind).name; }

std::string list_of_topic_kinds() {
  std::string list;
  for (const KindFacts& facts : all_kinds())
    list += facts.kind == RobotTopicKind::kRangeTo ? "range:PARTNER, " : std::string(facts.name) + ", ";
  return list + kTransforms + ", " + kClock;
}

const std::vector<std::string_view>& types_of(RobotTopicKind kind) { return facts_of(kind).types; }

RobotTopics robot_topics(const std::string& space, const std::vector<std::string>& stated) {
  RobotTopics topics;
  topics.space = space;
  std::set<std::string> seen;
  for (const std::string& text : stated) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos)
      throw InputError(kOption, 0, "'" + text + "' is not KIND=NAME, as scans=/lidar/points");
    const std::string what = text.substr(0, equals), name = text.substr(equals + 1);
    if (!seen.insert(what).second) throw InputError(kOption, 0, what + " is stated twice");
    if (what == kClock) {
      topics.clock = absolute(name, space, text);
    } else if (what == kTransforms) {
      topics.transforms = absolute(name, space, text);
      topics.static_transforms = topics.transforms + "_static";
    } else {
      RobotTopic topic = topic_of(what, text);
      if (name == kNowhere) continue;
      topic.name = absolute(name, space, text);
      topics.measured.push_back(std::move(topic));
    }
  }
  for (const KindFacts& facts : all_kinds())
    if (!seen.contains(facts.name))
      for (const char* nominal : facts.nominal)
        topics.measured.push_back({facts.kind, resolved_ros_name(nominal, space)});
  return topics;
}

}  // namespace radioslam
