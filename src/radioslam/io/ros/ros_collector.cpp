#include "radioslam/io/ros/ros_collector.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/base/statistics.hpp"
#include "radioslam/base/units.hpp"
#include "radioslam/geometry/se3.hpp"

namespace radioslam {
namespace {

constexpr const char* kNominalBody = "base_link";

/// The body frame; empty if it is unknown.
std::string body_frame(const RosTopicIndex& survey, const RosTopicChoice& choice) {
  if (choice.odometry && !choice.odometry->child.empty()) return choice.odometry->child;
  if (choice.odometry)
    if (const RosTopic* topic = survey.find(choice.odometry->topic); !topic->child.empty())
      return topic->child;
  for (const char* candidate : {kNominalBody, "base_footprint"})
    if (survey.frames.knows(candidate)) return candidate;
  return "";
}

/// T_body_sensor of a topic. Adds a warning if it has to be assumed.
SE3 extrinsics_of(const RosTopicIndex& survey, const std::string& body, const std::string& topic,
                  std::vector<std::string>& warnings) {
  const std::string& sensor = survey.find(topic)->frame;
  if (sensor == body) return {};
  if (!body.empty())
    if (const auto T_body_sensor = survey.frames.find(body, sensor)) return *T_body_sensor;
  if (body.empty() && sensor == kNominalBody) return {};
  warnings.push_back(topic + ": " +
                     (body.empty() ? "the body frame is unknown"
                                   : "no static transform connects " + body + " with " + sensor) +
                     "; '" + sensor + "' is assumed to be the body frame");
  return {};
}

constexpr double kNegligibleLever_m = 0.05;
constexpr double kUnknownFixSigma_m = 10;

constexpr const char* kTwice = "messages with the same stamp as another one are left out";
constexpr const char* kWithoutTime = "messages have no stamp; the recording time is used";
constexpr const char* kLeftWithoutTime =
    "messages have no stamp, unlike others of their topic, and are left out";
constexpr const char* kWithoutPose = "invalid poses (not finite, or without orientation) are left out";

/// Sorts by time and removes repeated stamps.
template <class Item>
void put_in_order(std::vector<Item>& items, const std::string& topic, RosCounts& counts) {
  std::stable_sort(items.begin(), items.end(),
                   [](const Item& a, const Item& b) { return a.stamp < b.stamp; });
  const auto end = std::unique(items.begin(), items.end(),
                               [](const Item& a, const Item& b) { return a.stamp == b.stamp; });
  if (end != items.end()) counts[topic + ": " + kTwice] += static_cast<std::size_t>(items.end() - end);
  items.erase(end, items.end());
}

/// The stamp of the header; nothing if it cannot be read.
std::optional<Stamp> stamp_of(const RosMessage& message) {
  try {
    return RosMessageReader(message).header().stamp;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

bool is_topic(const std::optional<RosPoseTopic>& chosen, const RosChannel& channel) {
  return chosen && chosen->topic == channel.topic;
}

}  // namespace

RosCollector::RosCollector(const RosTopicIndex& survey, RosTopicChoice choice, const RosScanSink& sink)
    : survey_(survey),
      choice_(std::move(choice)),
      sink_(sink),
      scan_messages_([this](Stamp stamp, RosScan scan) { take_scan(stamp, scan); }) {
  const std::string body = body_frame(survey, choice_);
  if (choice_.scans) T_body_laser_ = extrinsics_of(survey, body, *choice_.scans, collected_.warnings);
  if (choice_.imu) T_body_imu_ = extrinsics_of(survey, body, *choice_.imu, collected_.warnings);
  if (choice_.gnss)
    collected_.fix_lever_m = extrinsics_of(survey, body, *choice_.gnss, collected_.warnings).translation();
  if (choice_.wifi) wifi_definition_ = wifi_definition_of(*survey.find(*choice_.wifi));
  if (T_body_imu_.translation().norm() > kNegligibleLever_m)
    collected_.warnings.push_back(*choice_.imu +
                                  ": the IMU's position in the body frame is not taken into account");
}

bool RosCollector::reads(const RosChannel& channel) const {
  return is_topic(choice_.odometry, channel) || is_topic(choice_.truth, channel) ||
         channel.topic == choice_.scans || channel.topic == choice_.imu || channel.topic == choice_.gnss ||
         channel.topic == choice_.wifi;
}

void RosCollector::take(const RosMessage& message) {
  if (!reads(message.channel)) return;
  RosMessage timed = message;
  timed.stamp = {message.stamp.ns - survey_.recording_delay.ns};
  const std::string& topic = message.channel.topic;
  if (topic == choice_.scans) {
    if (is_timed(timed)) scan_messages_.take(timed);
    return;
  }
  try {
    take_small(timed);
    ++readable_[topic];
  } catch (const InputError& error) {
    unreadable_[topic].add(error);
  }
}

/// Whether the message has a time: its own, or that of its recording if no message of the topic has a stamp.
bool RosCollector::is_timed(const RosMessage& message) {
  const std::string& topic = message.channel.topic;
  if (stamp_of(message) != Stamp{}) return true;
  const bool is_left_out = survey_.find(topic)->has_stamps;
  count(topic, is_left_out ? kLeftWithoutTime : kWithoutTime, 1);
  return !is_left_out;
}

void RosCollector::take_small(const RosMessage& message) {
  const RosChannel& channel = message.channel;
  if (is_transforms_type(channel.type)) return transforms_[channel.topic].take(message);
  if (channel.topic == choice_.wifi) return take_wifi(message);
  if (!is_timed(message)) return;
  if (is_topic(choice_.odometry, channel)) take_pose(message, collected_.odometry);
  if (is_topic(choice_.truth, channel)) take_pose(message, collected_.truth);
  if (channel.topic == choice_.imu) take_inertial(message);
  if (channel.topic == choice_.gnss) take_fix(message);
}

void RosCollector::take_wifi(const RosMessage& message) {
  WifiMessage read = read_wifi_message(*wifi_definition_, message);
  count(message.channel.topic, "readings without an address or a level in dBm are left out", read.invalid);
  collected_.wifi.insert(collected_.wifi.end(), read.rows.begin(), read.rows.end());
}

RosCollected RosCollector::finish() {
  scan_messages_.finish();
  const auto notes = scan_messages_.notes();
  for (const auto& [topic, skipped] : unreadable_) {
    if (readable_[topic] == 0) skipped.throw_first();
    collected_.warnings.push_back(skipped.warning(topic, "message"));
  }
  collected_.warnings.insert(collected_.warnings.end(), notes.begin(), notes.end());
  if (choice_.odometry) finish_poses(*choice_.odometry, collected_.odometry);
  if (choice_.truth) finish_poses(*choice_.truth, collected_.truth);
  if (choice_.gnss) put_in_order(collected_.fixes, *choice_.gnss, collected_.counts);
  if (choice_.imu) put_in_order(collected_.inertial, *choice_.imu, collected_.counts);
  return std::move(collected_);
}

void RosCollector::count(const std::string& topic, const char* what, std::size_t number) {
  if (number > 0) collected_.counts[topic + ": " + what] += number;
}

void RosCollector::take_pose(const RosMessage& message, std::vector<StampedPose<SE3>>& poses) {
  const RosPose pose = read_ros_pose(message);
  if (pose.pose)
    poses.push_back({time_of(message, pose.header), *pose.pose});
  else
    count(message.channel.topic, kWithoutPose, 1);
}

void RosCollector::finish_poses(const RosPoseTopic& topic, std::vector<StampedPose<SE3>>& poses) {
  if (const auto transforms = transforms_.find(topic.topic); transforms != transforms_.end()) {
    TransformedPoses found = transforms->second.find(survey_.frames, topic.frame, topic.child);
    count(topic.topic, kWithoutTime, found.without_time);
    count(topic.topic, kLeftWithoutTime, found.left_without_time);
    count(topic.topic, kWithoutPose, found.without_pose);
    count(topic.topic,
          "poses are left out because another transform between the frames is unknown at their time",
          found.alone);
    poses = std::move(found.poses);
  }
  put_in_order(poses, topic.topic, collected_.counts);
}

void RosCollector::take_scan(Stamp stamp, RosScan& scan) {
  if (!collected_.scans.insert(stamp).second) return count(*choice_.scans, kTwice, 1);
  collected_.is_plane_scanner = survey_.find(*choice_.scans)->type == kLaserScanType;
  collected_.range_max_m = std::max(collected_.range_max_m, scan.range_max_m);
  const Eigen::Matrix3f R_body_laser = T_body_laser_.rotation().toRotationMatrix().cast<float>();
  const Eigen::Vector3f t_body_laser = T_body_laser_.translation().cast<float>();
  for (Eigen::Vector3f& point : scan.scan.points) {
    point = Eigen::Vector3f(R_body_laser * point + t_body_laser);
    if (collected_.is_plane_scanner) point.z() = 0;
  }
  sink_(stamp, scan.scan);
}

void RosCollector::take_fix(const RosMessage& message) {
  const RosFix fix = read_ros_fix(message);
  if (!fix.place) return count(message.channel.topic, "messages without a fix are left out", 1);
  if (!fix.sigma_m) count(message.channel.topic, "fixes state no sigma; 10 m is assumed", 1);
  collected_.fixes.push_back(
      {time_of(message, fix.header), *fix.place, fix.sigma_m.value_or(kUnknownFixSigma_m)});
}

void RosCollector::take_inertial(const RosMessage& message) {
  const RosImu reading = read_ros_imu(message);
  const Eigen::Quaterniond& R_body_imu = T_body_imu_.rotation();
  if (!reading.is_complete)
    count(message.channel.topic, "IMU samples are marked as incomplete (no rates or no forces) and left out",
          1);
  else if (reading.specific_force_mps2.allFinite() && reading.angular_rate_radps.allFinite())
    collected_.inertial.push_back({time_of(message, reading.header), R_body_imu * reading.specific_force_mps2,
                                   R_body_imu * reading.angular_rate_radps});
  else
    count(message.channel.topic, "IMU samples that are not finite are left out", 1);
}

}  // namespace radioslam
