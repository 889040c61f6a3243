#include "radioslam/io/ros/ros_collector.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/base/statistics.hpp"
#include "radioslam/base/units.hpp"
#include "radioslam/geometry/se3.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kScansToFindUnit = 10;

/// The typical interval between consecutive stamps; nothing if all stamps are equal.
std::optional<double> nominal_interval_s(std::vector<Stamp> stamps) {
  std::sort(stamps.begin(), stamps.end());
  std::vector<double> gaps_s;
  for (std::size_t k = 1; k < stamps.size(); ++k)
    if (stamps[k] != stamps[k - 1])
      gaps_s.push_back((static_cast<double>(stamps[k].ns) - static_cast<double>(stamps[k - 1].ns)) *
                       kSecondsPerNanosecond);
  return gaps_s.empty() ? std::nullopt : std::optional(upper_median(gaps_s));
}

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

bool is_topic(const std::optional<RosPoseTopic>& chosen, const RosChannel& channel) {
  return chosen && chosen->topic == channel.topic;
}

}  // namespace

void RosScans::take(const RosMessage& message) {
  topic_ = message.channel.topic;
  if (has_unit_) return hand_on(message);
  held_.push_back({message.channel, message.stamp, std::string(message.bytes), std::string(message.file)});
  if (held_.size() == kScansToFindUnit) finish();
}

void RosScans::finish() {
  if (!has_unit_) find_unit();
  for (const Held& held : held_) hand_on(held.message());
  held_.clear();
}

void RosScans::find_unit() {
  has_unit_ = true;
  std::vector<RawPointTimes> times;
  std::vector<Stamp> stamps;
  for (const Held& held : held_) {
    const RosMessage message = held.message();
    stamps.push_back(time_of(message, RosMessageReader(message).header()));
    if (const auto raw = read_ros_point_times(message)) times.push_back(*raw);
  }
  const auto interval = nominal_interval_s(stamps);
  if (times.empty() || !interval) return;
  unit_ = unit_of(times, *interval);
  if (*unit_ != times.front().nominal)
    unit_note_ = std::string("the points' times are assumed to be in ") + name_of(*unit_) + ": in " +
                 name_of(times.front().nominal) +
                 " the duration of a sweep would not match the interval between scans";
}

void RosScans::hand_on(const RosMessage& message) {
  RosScan scan = read_ros_scan(message, unit_);
  ++clocks_[scan.clock];
  take_(message, std::move(scan));
}

std::vector<std::string> RosScans::notes() const {
  std::vector<std::string> notes;
  if (unit_note_) notes.push_back(topic_ + ": " + *unit_note_);
  const auto note = [&](PointClock clock, const std::string& what) {
    if (const auto found = clocks_.find(clock); found != clocks_.end())
      notes.push_back(topic_ + ": the points' times " + what + ", in " + std::to_string(found->second) +
                      " scans");
  };
  note(PointClock::kOther,
       "are from another clock than the scans' stamps; the first point is assigned the stamp");
  note(PointClock::kCoarse, "are too coarse to distinguish points and are ignored");
  return notes;
}

RosCollector::RosCollector(const RosTopicIndex& survey, RosTopicChoice choice, const RosScanSink& sink)
    : frames_(survey.frames),
      choice_(std::move(choice)),
      sink_(sink),
      scan_messages_([this](const RosMessage& message, RosScan scan) { take_scan(message, scan); }) {
  const std::string body = body_frame(survey, choice_);
  if (choice_.scans) T_body_laser_ = extrinsics_of(survey, body, *choice_.scans, collected_.warnings);
  if (choice_.imu) T_body_imu_ = extrinsics_of(survey, body, *choice_.imu, collected_.warnings);
  if (choice_.gnss)
    collected_.fix_lever_m = extrinsics_of(survey, body, *choice_.gnss, collected_.warnings).translation();
  if (T_body_imu_.translation().norm() > kNegligibleLever_m)
    collected_.warnings.push_back(*choice_.imu +
                                  ": the IMU's position in the body frame is not taken into account");
}

bool RosCollector::reads(const RosChannel& channel) const {
  return is_topic(choice_.odometry, channel) || is_topic(choice_.truth, channel) ||
         channel.topic == choice_.scans || channel.topic == choice_.imu || channel.topic == choice_.gnss;
}

void RosCollector::take(const RosMessage& message) {
  if (reads(message.channel) && is_transforms_type(message.channel.type))
    return transforms_[message.channel.topic].take(message);
  if (is_topic(choice_.odometry, message.channel)) take_pose(message, collected_.odometry);
  if (is_topic(choice_.truth, message.channel)) take_pose(message, collected_.truth);
  if (message.channel.topic == choice_.scans) scan_messages_.take(message);
  if (message.channel.topic == choice_.imu) take_inertial(message);
  if (message.channel.topic == choice_.gnss) take_fix(message);
}

RosCollected RosCollector::finish() {
  scan_messages_.finish();
  const auto notes = scan_messages_.notes();
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

Stamp RosCollector::counted_time_of(const RosMessage& message, const RosHeader& header) {
  if (header.stamp == Stamp{}) count(message.channel.topic, kWithoutTime, 1);
  return time_of(message, header);
}

void RosCollector::take_pose(const RosMessage& message, std::vector<StampedPose<SE3>>& poses) {
  const RosPose pose = read_ros_pose(message);
  if (pose.pose)
    poses.push_back({counted_time_of(message, pose.header), *pose.pose});
  else
    count(message.channel.topic, kWithoutPose, 1);
}

void RosCollector::finish_poses(const RosPoseTopic& topic, std::vector<StampedPose<SE3>>& poses) {
  if (const auto transforms = transforms_.find(topic.topic); transforms != transforms_.end()) {
    TransformedPoses found = transforms->second.find(frames_, topic.frame, topic.child);
    count(topic.topic, kWithoutTime, found.without_time);
    count(topic.topic, kWithoutPose, found.without_pose);
    count(topic.topic,
          "poses are left out because another transform between the frames is unknown at their time",
          found.alone);
    poses = std::move(found.poses);
  }
  put_in_order(poses, topic.topic, collected_.counts);
}

void RosCollector::take_scan(const RosMessage& message, RosScan& scan) {
  const Stamp stamp = counted_time_of(message, scan.header);
  if (!collected_.scans.insert(stamp).second) {
    count(message.channel.topic, kTwice, 1);
    return;
  }
  collected_.is_plane_scanner = message.channel.type == kLaserScanType;
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
      {counted_time_of(message, fix.header), *fix.place, fix.sigma_m.value_or(kUnknownFixSigma_m)});
}

void RosCollector::take_inertial(const RosMessage& message) {
  const RosImu reading = read_ros_imu(message);
  const Eigen::Quaterniond& R_body_imu = T_body_imu_.rotation();
  if (!reading.is_complete)
    count(message.channel.topic, "IMU samples are marked as incomplete (no rates or no forces) and left out",
          1);
  else if (reading.specific_force_mps2.allFinite() && reading.angular_rate_radps.allFinite())
    collected_.inertial.push_back({counted_time_of(message, reading.header),
                                   R_body_imu * reading.specific_force_mps2,
                                   R_body_imu * reading.angular_rate_radps});
  else
    count(message.channel.topic, "IMU samples that are not finite are left out", 1);
}

}  // namespace radioslam
