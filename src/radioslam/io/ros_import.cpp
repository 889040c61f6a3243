#include "radioslam/io/ros_import.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "radioslam/base/input_error.hpp"
#include "radioslam/geometry/so3.hpp"
#include "radioslam/io/moving_transforms.hpp"
#include "radioslam/io/ros_recording.hpp"
#include "radioslam/io/ros_scans.hpp"

namespace radioslam {
namespace {

constexpr double kPlaneHeight_m = 0.1, kPlaneTilt = 0.05;  ///< the latter of the sine of half a tilt
constexpr const char* kUsualBody = "base_link";
constexpr double kNegligibleLever_m = 0.05;
constexpr double kUnknownFixSigma_m = 10;
constexpr double kLeastForce_mps2 = 5;  ///< a mean specific force below this is not in m/s^2

constexpr const char* kTwice = "messages of a time that another has are left out";
constexpr const char* kWithoutTime = "messages have no time of their own; the recording's is taken";
constexpr const char* kWithoutPose = "poses are none (not finite, or without orientation) and left out";

/// What is left out or replaced, by why.
using RosCounts = std::map<std::string, std::size_t>;

/// The body's frame, "" where nothing tells it.
std::string body_frame(const RosSurvey& survey, const RosTopicChoice& choice) {
  if (choice.odometry && !choice.odometry->child.empty()) return choice.odometry->child;
  if (choice.odometry)
    if (const RosTopic* topic = survey.find(choice.odometry->topic); !topic->child.empty())
      return topic->child;
  for (const char* usual : {kUsualBody, "base_footprint"})
    if (survey.frames.knows(usual)) return usual;
  return "";
}

/// T_body_sensor of a topic; `warnings` tell what it is taken from.
SE3 place_of_sensor(const RosSurvey& survey, const std::string& body, const std::string& topic,
                    std::vector<std::string>& warnings) {
  const std::string& sensor = survey.find(topic)->frame;
  if (sensor == body) return {};
  if (!body.empty())
    if (const auto T_body_sensor = survey.frames.find(body, sensor)) return *T_body_sensor;
  if (body.empty() && sensor == kUsualBody) return {};
  warnings.push_back(topic + ": " +
                     (body.empty() ? "nothing names the body's frame"
                                   : "no fixed transform leads from " + body + " to " + sensor) +
                     "; '" + sensor + "' is taken as the body's frame");
  return {};
}

/// In the order of time, each stamp once.
template <class Item>
void put_in_order(std::vector<Item>& items, const std::string& topic, RosCounts& counts) {
  std::stable_sort(items.begin(), items.end(),
                   [](const Item& a, const Item& b) { return a.stamp < b.stamp; });
  const auto end = std::unique(items.begin(), items.end(),
                               [](const Item& a, const Item& b) { return a.stamp == b.stamp; });
  if (end != items.end()) counts[topic + ": " + kTwice] += static_cast<std::size_t>(items.end() - end);
  items.erase(end, items.end());
}

struct GeodeticFix {
  Stamp stamp;
  GeodeticPlace place;
  double sigma_m = 0;
};

/// Collects what the chosen topics say.
class RosCollector {
 public:
  RosCollector(const RosSurvey& survey, RosTopicChoice choice, const RosScanSink& sink)
      : frames_(survey.frames),
        choice_(std::move(choice)),
        sink_(sink),
        scan_messages_([this](const RosMessage& message, RosScan scan) { take_scan(message, scan); }) {
    const std::string body = body_frame(survey, choice_);
    if (choice_.scans) T_body_laser_ = place_of_sensor(survey, body, *choice_.scans, warnings);
    if (choice_.imu) T_body_imu_ = place_of_sensor(survey, body, *choice_.imu, warnings);
    if (choice_.gnss) fix_lever_m = place_of_sensor(survey, body, *choice_.gnss, warnings).translation();
    if (T_body_imu_.translation().norm() > kNegligibleLever_m)
      warnings.push_back(*choice_.imu + ": the unit's place in the body is not accounted for");
  }
  RosCollector(const RosCollector&) = delete;
  RosCollector& operator=(const RosCollector&) = delete;

  bool reads(const RosChannel& channel) const {
    return is_topic(choice_.odometry, channel) || is_topic(choice_.truth, channel) ||
           channel.topic == choice_.scans || channel.topic == choice_.imu || channel.topic == choice_.gnss;
  }

  void take(const RosMessage& message) {
    if (reads(message.channel) && is_transforms_type(message.channel.type))
      return transforms_[message.channel.topic].take(message);
    if (is_topic(choice_.odometry, message.channel)) take_pose(message, odometry);
    if (is_topic(choice_.truth, message.channel)) take_pose(message, truth);
    if (message.channel.topic == choice_.scans) scan_messages_.take(message);
    if (message.channel.topic == choice_.imu) take_inertial(message);
    if (message.channel.topic == choice_.gnss) take_fix(message);
  }

  /// Behind the last message: everything in the order of time.
  void finish() {
    scan_messages_.finish();
    const auto notes = scan_messages_.notes();
    warnings.insert(warnings.end(), notes.begin(), notes.end());
    if (choice_.odometry) finish_poses(*choice_.odometry, odometry);
    if (choice_.truth) finish_poses(*choice_.truth, truth);
    if (choice_.gnss) put_in_order(fixes, *choice_.gnss, counts);
    if (choice_.imu) put_in_order(inertial, *choice_.imu, counts);
  }

  std::vector<StampedPose<SE3>> odometry, truth;
  std::vector<InertialSample> inertial;
  std::vector<GeodeticFix> fixes;
  Eigen::Vector3d fix_lever_m = Eigen::Vector3d::Zero();
  std::set<Stamp> scans;
  bool is_plane_scanner = false;
  double range_max_m = 0;  ///< of the plane's scanner; 0 where not told
  RosCounts counts;
  std::vector<std::string> warnings;

 private:
  static bool is_topic(const std::optional<RosPoseTopic>& chosen, const RosChannel& channel) {
    return chosen && chosen->topic == channel.topic;
  }

  void count(const std::string& topic, const char* what, std::size_t number) {
    if (number > 0) counts[topic + ": " + what] += number;
  }

  Stamp counted_time_of(const RosMessage& message, const RosHeader& header) {
    if (header.stamp == Stamp{}) count(message.channel.topic, kWithoutTime, 1);
    return time_of(message, header);
  }

  void take_pose(const RosMessage& message, std::vector<StampedPose<SE3>>& poses) {
    const RosPose pose = read_ros_pose(message);
    if (pose.pose)
      poses.push_back({counted_time_of(message, pose.header), *pose.pose});
    else
      count(message.channel.topic, kWithoutPose, 1);
  }

  void finish_poses(const RosPoseTopic& topic, std::vector<StampedPose<SE3>>& poses) {
    if (const auto transforms = transforms_.find(topic.topic); transforms != transforms_.end()) {
      TransformedPoses found = transforms->second.find(frames_, topic.frame, topic.child);
      count(topic.topic, kWithoutTime, found.without_time);
      count(topic.topic, kWithoutPose, found.without_pose);
      count(topic.topic, "poses are left out, for another transform between the frames is not known then",
            found.alone);
      poses = std::move(found.poses);
    }
    put_in_order(poses, topic.topic, counts);
  }

  void take_scan(const RosMessage& message, RosScan& scan) {
    const Stamp stamp = counted_time_of(message, scan.header);
    if (!scans.insert(stamp).second) {
      count(message.channel.topic, kTwice, 1);
      return;
    }
    is_plane_scanner = message.channel.type == kLaserScanType;
    range_max_m = std::max(range_max_m, scan.range_max_m);
    const Eigen::Matrix3f R_body_laser = T_body_laser_.rotation().toRotationMatrix().cast<float>();
    const Eigen::Vector3f t_body_laser = T_body_laser_.translation().cast<float>();
    for (Eigen::Vector3f& point : scan.scan.points) {
      point = Eigen::Vector3f(R_body_laser * point + t_body_laser);
      if (is_plane_scanner) point.z() = 0;
    }
    sink_(stamp, scan.scan);
  }

  void take_fix(const RosMessage& message) {
    const RosFix fix = read_ros_fix(message);
    if (!fix.place) return count(message.channel.topic, "readings have no fix and are left out", 1);
    if (!fix.sigma_m) count(message.channel.topic, "fixes tell no sigma; 10 m are taken", 1);
    fixes.push_back(
        {counted_time_of(message, fix.header), *fix.place, fix.sigma_m.value_or(kUnknownFixSigma_m)});
  }

  void take_inertial(const RosMessage& message) {
    const RosInertial reading = read_ros_inertial(message);
    const Eigen::Quaterniond& R_body_imu = T_body_imu_.rotation();
    if (!reading.is_whole)
      count(message.channel.topic, "readings lack rates or forces, as they say themselves, and are left out",
            1);
    else if (reading.specific_force_mps2.allFinite() && reading.angular_rate_radps.allFinite())
      inertial.push_back({counted_time_of(message, reading.header), R_body_imu * reading.specific_force_mps2,
                          R_body_imu * reading.angular_rate_radps});
    else
      count(message.channel.topic, "readings that are not finite are left out", 1);
  }

  const FrameTree& frames_;
  RosTopicChoice choice_;
  const RosScanSink& sink_;
  RosScans scan_messages_;
  std::map<std::string, MovingTransforms> transforms_;  ///< by topic
  SE3 T_body_laser_, T_body_imu_;
};

/// Poses from the first one's place and heading on.
Trajectory<SE3> from_start(std::vector<StampedPose<SE3>> poses) {
  if (poses.empty()) return {};
  const SE3& first = poses.front().pose;
  const SE3 T_start = SE3(first.translation(), so3_exp({0, 0, first.yaw()})).inverse();
  for (auto& entry : poses) entry.pose = T_start * entry.pose;
  return Trajectory<SE3>(std::move(poses));
}

bool is_plane(const Trajectory<SE3>& poses) {
  return std::all_of(poses.begin(), poses.end(), [](const StampedPose<SE3>& entry) {
    const Eigen::Quaterniond& rotation = entry.pose.rotation();
    return std::abs(entry.pose.translation().z()) < kPlaneHeight_m &&
           std::hypot(rotation.x(), rotation.y()) < kPlaneTilt;
  });
}

std::vector<PositionFix> local_fixes(const std::vector<GeodeticFix>& fixes, const GeodeticPlace& origin) {
  std::vector<PositionFix> local;
  for (const GeodeticFix& fix : fixes) {
    GeodeticPlace place = fix.place;
    if (!std::isfinite(place.height_m)) place.height_m = origin.height_m;
    local.push_back({fix.stamp, east_north_up_m(origin, place), fix.sigma_m});
  }
  return local;
}

/// The origin asked for, or the first fix; at height 0 where it tells none.
std::optional<GeodeticPlace> origin_of_fixes(const std::vector<GeodeticFix>& fixes,
                                             const std::optional<GeodeticPlace>& asked_for) {
  if (asked_for || fixes.empty()) return asked_for;
  GeodeticPlace origin = fixes.front().place;
  if (!std::isfinite(origin.height_m)) origin.height_m = 0;
  return origin;
}

/// Are the forces in units of the earth's gravity?
bool is_in_g(const std::vector<InertialSample>& samples) {
  double sum_mps2 = 0;
  for (const InertialSample& sample : samples) sum_mps2 += sample.specific_force_mps2.norm();
  return !samples.empty() && sum_mps2 < kLeastForce_mps2 * static_cast<double>(samples.size());
}

std::string without_poses(const RosPoseTopic& topic) {
  return topic.topic + " has no pose to import" +
         (topic.frame.empty()
              ? ""
              : ": no transforms lead from " + topic.frame + " to " + topic.child + " at one time");
}

RosImport mission_of(RosCollector& collected, const std::string& robot, bool has_scans) {
  RosImport result;
  result.scans = collected.scans.size();
  Robot& recorded = result.imported.mission.robots.emplace_back();
  recorded.id = robot;
  recorded.odometry = from_start(std::move(collected.odometry));
  recorded.inertial = std::move(collected.inertial);
  if (collected.range_max_m > 0) recorded.lidar_range_m = collected.range_max_m;
  const bool moves_in_plane = has_scans ? collected.is_plane_scanner : is_plane(recorded.odometry);
  result.imported.mission.dimension = moves_in_plane ? 2 : 3;
  if (!collected.truth.empty())
    result.imported.truth.robots.push_back({robot, Trajectory<SE3>(std::move(collected.truth)), true});
  return result;
}

void add_warnings(const RosCollector& collected, const RosSurvey& survey, const RosTopicChoice& choice,
                  std::vector<std::string>& warnings) {
  warnings = survey.warnings;
  warnings.insert(warnings.end(), collected.warnings.begin(), collected.warnings.end());
  for (const auto& [what, count] : collected.counts) {
    const std::size_t colon = what.find(": ");
    warnings.push_back(what.substr(0, colon + 2) + std::to_string(count) + what.substr(colon + 1));
  }
  std::vector<RosTopic> poses;
  for (const RosTopic& topic : survey.topics)
    if (is_pose_type(topic.type) && topic.type != kOdometryType) poses.push_back(topic);
  if (!choice.truth && !poses.empty())
    warnings.push_back("no poses are taken as the truth; --truth TOPIC does: " + list_of_topics(poses));
}

}  // namespace

RosImport import_ros_recording(const std::filesystem::path& source, const std::string& robot,
                               const RosTopicWishes& wishes, const RosScanSink& sink,
                               const std::optional<GeodeticPlace>& fix_origin) {
  const RosSurvey survey = survey_recording(source);
  const RosTopicChoice choice = choose_topics(source.string(), survey, wishes);
  RosCollector collected(survey, choice, sink);
  visit_recording(source, {[&](const RosChannel& channel) { return collected.reads(channel); },
                           [&](const RosMessage& message) { collected.take(message); }});
  collected.finish();
  if (choice.odometry && collected.odometry.empty() && collected.scans.empty())
    throw InputError(source.string(), 0, without_poses(*choice.odometry));
  if (choice.odometry && collected.odometry.empty())
    collected.warnings.push_back(without_poses(*choice.odometry));
  if (choice.truth && collected.truth.empty()) collected.warnings.push_back(without_poses(*choice.truth));
  if (is_in_g(collected.inertial))
    collected.warnings.push_back(*choice.imu + ": forces are far below 9.81 m/s2; are they in g?");
  RosImport result = mission_of(collected, robot, choice.scans.has_value());
  result.fix_origin = origin_of_fixes(collected.fixes, fix_origin);
  if (!collected.fixes.empty()) {
    Robot& recorded = result.imported.mission.robots.front();
    recorded.fixes = local_fixes(collected.fixes, *result.fix_origin);
    recorded.fix_lever_m = collected.fix_lever_m;
  }
  add_warnings(collected, survey, choice, result.imported.warnings);
  return result;
}

}  // namespace radioslam
