#include "radioslam/io/ros/ros_import.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "radioslam/base/input_error.hpp"
#include "radioslam/base/statistics.hpp"
#include "radioslam/io/mission/recorded_odometry.hpp"
#include "radioslam/io/ros/ros_collector.hpp"
#include "radioslam/io/ros/ros_recording.hpp"

namespace radioslam {
namespace {

constexpr double kMaxOriginDistance_m = 1e5, kMaxFixDistance_m = 1e6;
constexpr double kMinForce_mps2 = 5;  ///< a smaller mean specific force is not in m/s^2

std::vector<PositionFix> local_fixes(const std::vector<GeodeticFix>& fixes, const GeodeticPlace& origin) {
  std::vector<PositionFix> local;
  for (const GeodeticFix& fix : fixes) {
    GeodeticPlace place = fix.place;
    if (!std::isfinite(place.height_m)) place.height_m = origin.height_m;
    local.push_back({fix.stamp, east_north_up_m(origin, place), fix.sigma_m});
  }
  return local;
}

/// Every robot's fixes of a team, in order.
std::vector<GeodeticPlace> places_of(const std::vector<RosImport>& team) {
  std::vector<GeodeticPlace> places;
  for (const RosImport& robot : team)
    for (const GeodeticFix& fix : robot.fixes) {
      places.push_back(fix.place);
      if (!std::isfinite(places.back().height_m)) places.back().height_m = 0;
    }
  return places;
}

/// The median of each coordinate, from the earth's centre.
Eigen::Vector3d middle_m(const std::vector<GeodeticPlace>& places) {
  Eigen::Vector3d middle;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> coordinates;
    for (const GeodeticPlace& place : places) coordinates.push_back(earth_centred_m(place)(axis));
    middle(axis) = upper_median(coordinates);
  }
  return middle;
}

/// The first fix near the middle of all; with altitude 0 if it has none.
GeodeticPlace origin_of(const std::vector<GeodeticPlace>& places) {
  const Eigen::Vector3d middle = middle_m(places);
  const auto agreeing = std::find_if(places.begin(), places.end(), [&](const GeodeticPlace& place) {
    return (earth_centred_m(place) - middle).norm() < kMaxOriginDistance_m;
  });
  return agreeing == places.end() ? places.front() : *agreeing;
}

/// Whether the forces seem to be in units of g.
bool is_in_g(const std::vector<ImuSample>& samples) {
  double sum_mps2 = 0;
  for (const ImuSample& sample : samples) sum_mps2 += sample.specific_force_mps2.norm();
  return !samples.empty() && sum_mps2 < kMinForce_mps2 * static_cast<double>(samples.size());
}

std::string without_poses(const RosPoseTopic& topic) {
  return topic.topic + " has no valid pose" +
         (topic.frame.empty()
              ? ""
              : ": no transforms connect " + topic.frame + " with " + topic.child + " at any time");
}

RosImport mission_of(RosCollected& collected, const std::string& robot, bool has_scans) {
  RosImport result;
  result.scans = collected.scans.size();
  Robot& recorded = result.imported.mission.robots.emplace_back();
  recorded.id = robot;
  recorded.odometry = from_start(std::move(collected.odometry));
  recorded.inertial = std::move(collected.inertial);
  if (collected.range_max_m > 0) recorded.lidar_range_m = collected.range_max_m;
  const bool moves_in_plane = has_scans ? collected.is_plane_scanner : is_in_plane(recorded.odometry);
  result.imported.mission.dimension = moves_in_plane ? 2 : 3;
  if (!collected.truth.empty())
    result.imported.truth.robots.push_back({robot, Trajectory<SE3>(std::move(collected.truth)), true});
  return result;
}

void add_warnings(const RosCollected& collected, const RosTopicIndex& survey, const RosTopicChoice& choice,
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
    warnings.push_back("no poses are used as ground truth; --truth TOPIC selects one of " +
                       list_of_topics(poses));
}

}  // namespace

RosImport import_ros_recording(const std::filesystem::path& source, const std::string& robot,
                               const RosTopicRequest& wishes, const RosScanSink& sink) {
  const RosTopicIndex survey = index_recording(source);
  const RosTopicChoice choice = choose_topics(source.string(), survey, wishes);
  RosCollector collector(survey, choice, sink);
  visit_recording(source, {[&](const RosChannel& channel) { return collector.reads(channel); },
                           [&](const RosMessage& message) { collector.take(message); }});
  RosCollected collected = collector.finish();
  if (choice.odometry && collected.odometry.empty() && collected.scans.empty())
    throw InputError(source.string(), 0, without_poses(*choice.odometry));
  if (choice.odometry && collected.odometry.empty())
    collected.warnings.push_back(without_poses(*choice.odometry));
  if (choice.truth && collected.truth.empty()) collected.warnings.push_back(without_poses(*choice.truth));
  if (is_in_g(collected.inertial))
    collected.warnings.push_back(*choice.imu + ": specific forces are far below 9.81 m/s2; are they in g?");
  RosImport result = mission_of(collected, robot, choice.scans.has_value());
  if (!collected.fixes.empty()) result.imported.mission.robots.front().fix_lever_m = collected.fix_lever_m;
  result.fixes = std::move(collected.fixes);
  result.wifi = join_wifi_logs({WifiLog{std::move(collected.wifi), {}, {}}});
  add_warnings(collected, survey, choice, result.imported.warnings);
  for (const RosTopic& topic : survey.topics)
    if (collector.reads({topic.name, topic.type})) result.topics.insert(topic.name);
  result.index = survey;
  return result;
}

void place_fixes(std::vector<RosImport>& team) {
  const std::vector<GeodeticPlace> places = places_of(team);
  if (places.empty()) return;
  const GeodeticPlace origin = origin_of(places);
  for (RosImport& robot : team) {
    std::vector<PositionFix> local = local_fixes(robot.fixes, origin);
    const std::size_t far = std::erase_if(
        local, [](const PositionFix& fix) { return fix.position_m.norm() > kMaxFixDistance_m; });
    Robot& recorded = robot.imported.mission.robots.front();
    recorded.fixes = std::move(local);
    if (far > 0)
      robot.imported.warnings.push_back(std::to_string(far) + " position fixes of " + recorded.id +
                                        " are more than 1000 km from the team's and are left out");
  }
}

}  // namespace radioslam
